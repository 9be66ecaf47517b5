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

// ---- the bars of the budget
var rows = Array.prototype.slice.call(document.querySelectorAll('.budget .row')), size = 0, bars = [];
var follows =
        ['acne', 'peter_panning', 'aliasing_dark', 'aliasing_light', 'coverage', 'leak', 'over_darkening', 'reduction'],
    sums = {aliasing_dark: 1, aliasing_light: 1, aliasing: 1, coverage_dark: 1, coverage_light: 1, light_size: 1};
// The causes of a point at its recommended bias or reduction; those that no curve gives, as rendered.
function causesOf(p) {
  var out = {};
  data.causes.forEach(function(c) {
    var v = p.metrics[c.name];
    if (follows.indexOf(c.name) < 0 && !sums[c.name] && kit.finite(v) && v > 0) out[c.name] = v;
  });
  follows.forEach(function(c) {
    if (p.at.metrics && p.at.metrics[c] > 0) out[c] = p.at.metrics[c];
  });
  return out;
}
rows.forEach(function(row) {
  var p = kit.byId[row.dataset.point], bar = row.querySelector('.bar'), value = row.querySelector('.value');
  var one = {
    row: row,
    bar: bar,
    value: value,
    set: {html: bar.innerHTML, size: bar.getAttribute('style'), text: value.textContent, title: row.title}
  };
  if (p && p.at) {
    one.causes = causesOf(p);
    one.sum = Object.keys(one.causes).reduce(function(sum, c) {
      return sum + one.causes[c];
    }, 0);
    size = Math.max(size, one.sum);
    one.error = (p.at.metrics || {}).error;
  }
  bars.push(one);
});
function budget() {
  bars.forEach(function(one) {
    if (page.bias === 'set' || !one.causes) {
      one.bar.innerHTML = one.set.html;
      one.bar.setAttribute('style', one.set.size);
      one.value.textContent = one.set.text;
      one.row.title = one.set.title;
      return;
    }
    one.bar.textContent = '';
    one.bar.setAttribute('style', '--size:' + (size > 0 ? one.sum / size : 0).toFixed(5));
    one.row.title = Object.keys(one.causes)
                        .map(function(c) {
                          var share = (100 * one.causes[c] / one.sum).toFixed(4);
                          one.bar.append(kit.make('i', {class: 'c-' + c, style: 'flex-grow:' + share}));
                          return (kit.causeLabel[c] || c) + ' ' + kit.shown(one.causes[c], 'fraction');
                        })
                        .join(', ');
    one.value.textContent = kit.finite(one.error) ? kit.shown(one.error, 'fraction') : 'not finite';
  });
}
page.onBias.push(budget);
budget();
})();
