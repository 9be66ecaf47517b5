// Runs in the report's page (tests/app/live_page_test.cpp): the live picture at several biases, as its pixels.
(async () => {
  'use strict';
  const saw = {errors: errors, pictures: []};
  await window.noonmarkPage.liveReady;
  const live = window.noonmarkPage.live, canvas = live.canvas;
  const stack = live.data.kind === 'stack';
  const biases = stack ? live.stops : [0, 1e-6, 1e-4, 3e-4, 1e-3, 2e-3, 5e-3, 0.01, 0.03, 0.2];
  biases.forEach(unit => {
    ['map', 'causes', 'truth'].forEach(kind => {
      live.show(kind);
      live.set(stack ? unit : unit * live.data.depth_per_unit);
      const pixels = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
      let text = '';
      for (let i = 0; i < pixels.length; i += 4)
        for (let k = 0; k < 3; ++k) text += (256 + pixels[i + k]).toString(16).slice(1);
      saw.pictures.push({bias: unit, kind: kind, pixels: text});
    });
  });
  saw.size = [canvas.width, canvas.height];
  // The slider answers the keyboard: a step to the right is a larger bias.
  live.set(stack ? live.stops[1] : 1e-3);
  const slider = document.querySelector('.bias-slider input'), before = slider.getAttribute('aria-valuetext');
  slider.value = +slider.value + (stack ? 1 : 100);
  slider.dispatchEvent(new Event('input', {bubbles: true}));
  saw.moved = slider.getAttribute('aria-valuetext') !== before;
  // Between two pictures of a stack the nearer one is shown.
  if (stack) {
    live.set(0.4 * live.stops[4] + 0.6 * live.stops[5]);
    saw.snapped = [slider.getAttribute('aria-valuetext'), slider.value];
    live.set(live.stops[5]);
    saw.stop = [slider.getAttribute('aria-valuetext'), slider.value];
  }
  saw.marks = document.querySelectorAll('.bias-marks .stop').length;
  saw.caption = document.querySelector('#live-picture figcaption').textContent;

  leave(saw);
})();
