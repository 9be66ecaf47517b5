// One value of the free setting (a bias, or a light-bleed reduction) for the whole page: as set, or the recommended one of each
// choice. What shows numbers or pictures at a bias reads page.bias, or listens to page.onBias.
(function() {
'use strict';
var page = window.noonmarkPage, kit = page.kit, data = page.data;
var any = data.points.some(function(p) {
  return p.at;
});
var root = document.documentElement;
function apply(mode) {
  page.bias = mode;
  root.classList.toggle('bias-recommended', mode === 'recommended');
}
page.setBias = function(mode) {
  apply(mode);
  page.onBias.forEach(function(f) {
    f(mode);
  });
  page.redraw();
};
if (!any) return;
var box = kit.make(
    'div', {class: 'bias-choice', role: 'group', 'aria-label': kit.freeLabel(data.free) + ' of all figures'},
    kit.freeLabel(data.free));
box.append(kit.segments([['set', 'As set'], ['recommended', data.bias_word]], page.bias, page.setBias));
document.querySelector('nav').append(box);
apply(page.bias);
})();
