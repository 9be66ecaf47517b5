// Error and causes of one point with a map of moments against another setting of its lookup (curve.over). Its values stand side by
// side, each with its name, because 0 has no place on a logarithmic axis.
(function() {
'use strict';
var page = window.noonmarkPage, kit = page.kit, of = kit.curve;
var curved = page.data.points.filter(function(p) {
  return p.over;
});
if (!curved.length) return;
var id = curved[0].id;
var dashes = {exact_map: of.errorDash, over_darkening: [8, 2, 1.5, 2]};
var series = ['error', 'exact_map', 'leak', 'reduction', 'over_darkening', 'peter_panning'];
var words = {error: 'Error that OpenGL shows', exact_map: 'Error on the exact map, without rounding'};

function nameOf(s) {
  return words[s] || of.nameOf(s);
}
function colourOf(s) {
  return s === 'exact_map' ? 'var(--ink)' : of.colourOf(s);
}
function thickOf(s) {
  return s === 'error' ? 2.4 : 1.5;
}
function titleOf(curve) {
  return curve.parameter + (curve.unit ? ' in ' + curve.unit : '');
}
function best(curve) {
  return curve.error.indexOf(Math.min.apply(null, curve.error.filter(kit.finite)));
}

var stops, self = kit.chart('over', function(width) {
  var curve = kit.byId[id].over, names = curve.value.map(kit.digits);
  var left = 64, right = 16, w = width - left - right, h = width < 520 ? 260 : 340;
  var step = w / Math.max(1, names.length - 1);
  var drawn = series.filter(function(s) {
    return curve[s].some(function(v) {
      return v > 0;
    });
  });
  stops = null;
  if (!drawn.length) {
    self.plot.append(kit.make('p', {class: 'small'}, 'The error is 0 at every value.'));
    return null;
  }
  var range = of.range([].concat.apply([], drawn.map(function(s) {
    return curve[s];
  })));
  var rows = [];
  drawn.forEach(function(s) {
    names.forEach(function(name, i) {
      if (of.onAxis(curve[s], i, range.bottom, true))
        rows.push({
          series: s,
          place: i * step,
          v: Math.max(curve[s][i], range.bottom),
          colour: colourOf(s),
          dash: dashes[s] || [1, 0],
          thick: thickOf(s)
        });
    });
  });
  function at(i) {
    return {value: i * step};
  }
  var marks = [of.lines({field: 'place'})];
  [[best(curve), 'least error', 0], [curve.value.indexOf(curve.as_set), 'as set', 1]].forEach(function(m) {
    if (m[0] >= 0) marks = marks.concat(of.mark(at(m[0]), m[1], m[2], m[0] > 0.7 * names.length ? -1 : 1, h));
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
        {name: 'x', type: 'point', domain: names, range: [0, w]},
        {name: 'y', type: 'log', zero: false, domain: [range.bottom, range.top], range: [h, 0]}
      ],
      axes: [of.axis(range), {orient: 'bottom', scale: 'x', labelOverlap: true, title: titleOf(curve)}],
      marks: marks
    },
    hover: function(view, plot) {
      stops = of.hover(view, plot, {
        left: left,
        count: names.length,
        place: function(i) {
          return i * step;
        },
        nearest: function(px) {
          return Math.max(0, Math.min(names.length - 1, Math.round(px / step)));
        },
        tip: function(i) {
          return {
            rows: series.map(function(s) {
              return [nameOf(s), kit.shown(curve[s][i], 'fraction'), s in words ? '' : s];
            }),
            title: curve.parameter + ' ' + names[i]
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
function controls() {
  self.controls.textContent = '';
  if (curved.length > 1) self.controls.append(kit.pointPicker(curved, id));
}
series.forEach(function(s) {
  var dash = s === 'error' ? [1, 0] : dashes[s];
  self.legend.append(of.key(s, words[s], dash, {thick: thickOf(s), colour: colourOf(s)}));
});
page.onSelect.push(function(chosen) {
  if (!kit.byId[chosen].over) return;
  id = chosen;
  controls();
  self.draw();
});
controls();
})();
