// Error and causes of one point with a map of moments against lookup.reduction. The usable window is shaded.
(function() {
'use strict';
var page = window.noonmarkPage, kit = page.kit, of = kit.curve;
var curved = page.data.points.filter(function(p) {
  return p.reductions;
});
if (!curved.length) return;
var recommended = kit.byId[page.data.recommended];
var id = recommended && recommended.reductions ? recommended.id : curved[0].id;
// Over-darkening and what the reduction darkens have colours of one family.
var dashes = {error: of.errorDash, over_darkening: [8, 2, 1.5, 2]};
var causes = ['leak', 'reduction', 'over_darkening', 'peter_panning'];

var stops, self = kit.chart('reduction', function(width) {
  var point = kit.byId[id], curve = point.reductions, values = curve.value;
  var left = 64, right = 16, w = width - left - right, h = width < 520 ? 260 : 340;
  var series = ['error'].concat(causes).filter(function(s) {
    return curve[s].some(function(v) {
      return v > 0;
    });
  });
  stops = null;
  if (!series.length) {
    self.plot.append(kit.make('p', {class: 'small'}, 'The value is 0 at every reduction.'));
    return null;
  }
  var bounds = [[curve.peter_panning_bound, 'bound on the leak'], [curve.acne_bound, 'bound on what is darkened']];
  var all = bounds.map(function(b) {
    return b[0];
  });
  series.forEach(function(s) {
    all = all.concat(curve[s]);
  });
  var range = of.range(all), rows = [];
  series.forEach(function(s) {
    values.forEach(function(r, i) {
      if (of.onAxis(curve[s], i, range.bottom, true))
        rows.push({
          series: s,
          r: r,
          v: Math.max(curve[s][i], range.bottom),
          colour: of.colourOf(s),
          dash: dashes[s] || [1, 0],
          thick: s === 'error' ? 1.5 : 2.4
        });
    });
  });
  function at(r) {
    return {scale: 'x', value: r};
  }
  var marks = [], usable = kit.windowOfReduction(point);
  if (usable) marks.push(of.window(at(usable.from), at(usable.to), h));
  marks = marks.concat(of.bounds(bounds, w, 4));
  marks.push(of.lines({scale: 'x', field: 'r'}));
  [[curve.least.value, 'least error', 0], [curve.as_set, 'as set', 1]].forEach(function(m) {
    if (kit.finite(m[0])) marks = marks.concat(of.mark(at(m[0]), m[1], m[2], m[0] > 0.7 ? -1 : 1, h));
  });
  marks.push(of.cursor(h));
  return {
    spec: {
      width: w,
      height: h,
      padding: {left: left, right: right, top: 6, bottom: 46},
      autosize: 'none',
      signals: [{name: 'hover', value: -1}],
      data: [{name: 'rows', values: rows}],
      scales: [
        {name: 'x', type: 'linear', zero: true, domain: [0, values[values.length - 1]], range: [0, w]},
        {name: 'y', type: 'log', zero: false, domain: [range.bottom, range.top], range: [h, 0]}
      ],
      axes: [of.axis(range), {orient: 'bottom', scale: 'x', tickCount: 10, title: 'lookup.reduction'}],
      marks: marks
    },
    hover: function(view, plot) {
      var x = view.scale('x');
      stops = of.hover(view, plot, {
        left: left,
        count: values.length,
        place: function(i) {
          return x(values[i]);
        },
        nearest: function(px) {
          var r = x.invert(px), i = 0;
          values.forEach(function(v, j) {
            if (Math.abs(v - r) < Math.abs(values[i] - r)) i = j;
          });
          return i;
        },
        tip: function(i) {
          return {
            rows: ['error'].concat(causes).map(function(s) {
              return [of.nameOf(s), kit.shown(curve[s][i], 'fraction'), s === 'error' ? '' : s];
            }),
            title: 'reduction ' + kit.digits(values[i])
          };
        }
      });
    }
  };
});
if (!self) return;
kit.keyboard(self, function() {
  return stops ? stops() : [];
});
var facts = kit.make('p', {class: 'facts'});
self.legend.before(facts);
function describe() {
  var point = kit.byId[id], usable = kit.windowOfReduction(point);
  facts.textContent = '';
  if (usable)
    facts.append(
        'Usable from ', kit.make('b', {}, kit.digits(usable.from)), ' to ', kit.make('b', {}, kit.digits(usable.to)),
        usable.placed ? ' at every placement of the grid. ' : '. ');
  else if (point.no_window)
    facts.append(kit.make('b', {style: 'color:var(--bad)'}, 'The usable window is ' + point.no_window + '. '));
  else
    facts.append(
        kit.make('b', {style: 'color:var(--bad)'}, 'No usable window. '),
        (point.reductions.why || 'No reduction keeps the bounds') + '. ');
  facts.append(
      'Least error at ' + kit.digits(point.reductions.least.value) + ', with ' +
      kit.shown(point.reductions.least.error, 'fraction') + '.');
}
function controls() {
  self.controls.textContent = '';
  if (curved.length > 1) self.controls.append(kit.pointPicker(curved, id));
}
['error'].concat(causes).forEach(function(s) {
  self.legend.append(of.key(s, s === 'error' ? 'Error, mean |R5 − R1|' : '', dashes[s]));
});
page.onSelect.push(function(chosen) {
  if (!kit.byId[chosen].reductions) return;
  id = chosen;
  controls();
  describe();
  self.draw();
});
controls();
describe();
})();
