// Runs in the report's page (tests/app/recommended_picture_test.cpp): what the first figure shows as the page opens, and at
// each bias that its buttons choose.
(async () => {
  'use strict';
  const saw = {errors};
  await window.noonmarkPage.liveReady;
  const figure = document.querySelector('#live-picture'), whole = figure.querySelector('img.whole');
  function now() {
    const source = Array.prototype.filter.call(
        document.querySelectorAll('.pictures figure img'), i => !whole.hidden && i.src === whole.src)[0];
    return {
      whole: source ? source.closest('figure').dataset.name : '',
      canvas: !figure.querySelector('canvas').hidden,
      facts: figure.querySelector('.facts').textContent,
      bias: window.noonmarkPage.bias
    };
  }
  function press(label) {
    Array.prototype.filter.call(figure.querySelectorAll('button'), b => b.textContent === label)[0].click();
    return now();
  }
  saw.opened = now();
  saw.causes = press('Causes');
  saw.truth = press('Truth');
  saw.set = press('As set');
  saw.pictures = Array.from(document.querySelectorAll('.pictures figure'), f => f.dataset.name);
  leave(saw);
})();
