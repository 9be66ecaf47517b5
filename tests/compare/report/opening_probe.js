// Runs in the report's page (tests/app/recommended_picture_test.cpp): what the first figure shows as the page opens, and at
// each bias that its buttons choose.
(async function() {
'use strict';
var saw = {errors: errors};
await window.noonmarkPage.liveReady;
var figure = document.querySelector('#live-picture'), whole = figure.querySelector('img.whole');
function now() {
  var source = Array.prototype.filter.call(document.querySelectorAll('.pictures figure img'), function(i) {
    return !whole.hidden && i.src === whole.src;
  })[0];
  return {
    whole: source ? source.closest('figure').dataset.name : '',
    canvas: !figure.querySelector('canvas').hidden,
    facts: figure.querySelector('.facts').textContent,
    bias: window.noonmarkPage.bias
  };
}
function press(label) {
  Array.prototype.filter
      .call(
          figure.querySelectorAll('button'),
          function(b) {
            return b.textContent === label;
          })[0]
      .click();
  return now();
}
saw.opened = now();
saw.causes = press('Causes');
saw.truth = press('Truth');
saw.set = press('As set');
saw.pictures = Array.prototype.map.call(document.querySelectorAll('.pictures figure'), function(f) {
  return f.dataset.name;
});
leave(saw);
})();
