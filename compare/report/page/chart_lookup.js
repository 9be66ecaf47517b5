// Error and causes of one point of a filtered map against a setting that only its lookup reads: lookup.reduction, whose usable
// window is shaded, and the setting of curve.over, whose values stand side by side, each with its name, because 0 has no place on
// a logarithmic axis.
(function() {
'use strict';
var page = window.noonmarkPage, kit = page.kit, of = kit.curve;
var series = ['error', 'exact_map', 'leak', 'reduction', 'over_darkening', 'peter_panning'];
var words = {error: 'Error that OpenGL shows', exact_map: 'Error on the exact map, without rounding'};
// Over-darkening and what the reduction darkens have colours of one family.
var dashes = {error: of.errorDash, exact_map: [2, 2], over_darkening: [8, 2, 1.5, 2]};

function nameOf(s) {
  return words[s] || of.nameOf(s);
}
function lookOf(s) {
  return words[s] ? {thick: 1.5, colour: 'var(--ink)'} : {thick: 2.4, colour: of.colourOf(s)};
}

// key: of the curve in the data of a point. Of a reduction the axis is linear.
function chartOver(place, key) {
  var curved = page.data.points.filter(function(p) {
    return p[key];
  });
  if (!curved.length) return;
  var recommended = kit.byId[page.data.recommended];
  var id = recommended && recommended[key] ? recommended.id : curved[0].id, linear = key === 'reductions';

  var stops, self = kit.chart(place, function(width) {
    var point = kit.byId[id], curve = point[key], values = curve.value;
    var left = 64, right = 16, w = width - left - right, h = width < 520 ? 260 : 340;
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
    // Pixels from the left end of the axis; not finite: the value has no place.
    function across(value) {
      if (linear) return value / values[values.length - 1] * w;
      var i = values.indexOf(value);
      return i < 0 ? NaN : i / Math.max(1, values.length - 1) * w;
    }
    function at(value) {
      return {value: across(value)};
    }
    var bounds = curve.acne_bound === undefined ?
        [] :
        [[curve.peter_panning_bound, 'bound on the leak'], [curve.acne_bound, 'bound on what is darkened']];
    var all = bounds.map(function(b) {
      return b[0];
    });
    drawn.forEach(function(s) {
      all = all.concat(curve[s]);
    });
    var range = of.range(all), rows = [];
    drawn.forEach(function(s) {
      values.forEach(function(value, i) {
        if (of.onAxis(curve[s], i, range.bottom, true))
          rows.push(Object.assign(
              {
                series: s,
                value: value,
                place: across(value),
                v: Math.max(curve[s][i], range.bottom),
                dash: dashes[s] || [1, 0]
              },
              lookOf(s)));
      });
    });
    var marks = [], usable = linear && kit.windowOfReduction(point);
    if (usable) marks.push(of.window(at(usable.from), at(usable.to), h));
    marks = marks.concat(of.bounds(bounds, w, 4));
    marks.push(of.lines({field: 'place'}));
    [[curve.least.value, 'least error', 0], [curve.as_set, 'as set', 1]].forEach(function(m) {
      var x = across(m[0]);
      if (kit.finite(x)) marks = marks.concat(of.mark(at(m[0]), m[1], m[2], x > 0.7 * w ? -1 : 1, h));
    });
    marks.push(of.cursor(h));
    var title = curve.parameter + (curve.unit ? ' in ' + curve.unit : '');
    var scale = linear ? {type: 'linear', zero: true, domain: [0, values[values.length - 1]]} :
                         {type: 'point', domain: values.map(kit.digits)};
    return {
      spec: {
        width: w,
        height: h,
        padding: {left: left, right: right, top: 6, bottom: 46},
        autosize: 'none',
        signals: [{name: 'hover', value: -1}],
        data: [{name: 'rows', values: rows}],
        scales: [
          Object.assign({name: 'x', range: [0, w]}, scale),
          {name: 'y', type: 'log', zero: false, domain: [range.bottom, range.top], range: [h, 0]}
        ],
        axes: [of.axis(range), {orient: 'bottom', scale: 'x', tickCount: 10, labelOverlap: true, title: title}],
        marks: marks
      },
      hover: function(view, plot) {
        stops = of.hover(view, plot, {
          left: left,
          count: values.length,
          place: function(i) {
            return across(values[i]);
          },
          nearest: function(px) {
            var best = 0;
            values.forEach(function(value, i) {
              if (Math.abs(across(value) - px) < Math.abs(across(values[best]) - px)) best = i;
            });
            return best;
          },
          tip: function(i) {
            return {
              rows: series.map(function(s) {
                return [nameOf(s), kit.shown(curve[s][i], 'fraction'), words[s] ? '' : s];
              }),
              title: curve.parameter + ' ' + kit.digits(values[i])
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
    var point = kit.byId[id], curve = point[key], usable = linear && kit.windowOfReduction(point);
    facts.textContent = '';
    if (usable)
      facts.append(
          'Usable from ', kit.make('b', {}, kit.digits(usable.from)), ' to ', kit.make('b', {}, kit.digits(usable.to)),
          usable.placed ? ' at every placement of the grid. ' : '. ');
    else if (linear && point.no_window)
      facts.append(kit.make('b', {style: 'color:var(--bad)'}, 'The usable window is ' + point.no_window + '. '));
    else if (linear)
      facts.append(
          kit.make('b', {style: 'color:var(--bad)'}, 'No usable window. '),
          (curve.why || 'No reduction keeps the bounds') + '. ');
    facts.append(
        'Least error at ' + kit.digits(curve.least.value) + ', with ' + kit.shown(curve.least.error, 'fraction') + '.');
  }
  function controls() {
    self.controls.textContent = '';
    if (curved.length > 1) self.controls.append(kit.pointPicker(curved, id));
  }
  series.forEach(function(s) {
    self.legend.append(of.key(s, words[s], dashes[s], lookOf(s)));
  });
  page.onSelect.push(function(chosen) {
    if (!kit.byId[chosen][key]) return;
    id = chosen;
    controls();
    describe();
    self.draw();
  });
  controls();
  describe();
}
chartOver('reduction', 'reductions');
chartOver('over', 'over');
})();
