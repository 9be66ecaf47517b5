// Error and causes of one point with a map of moments against lookup.reduction. The usable window is shaded.
(function() {
'use strict';
var page = window.noonmarkPage, kit = page.kit;
var curved = page.data.points.filter(function(p) {
  return p.reductions;
});
if (!curved.length) return;
var recommended = kit.byId[page.data.recommended];
var id = recommended && recommended.reductions ? recommended.id : curved[0].id;
// Over-darkening and what the reduction darkens have colours of one family.
var dashes = {error: [5, 3], over_darkening: [8, 2, 1.5, 2]};
var causes = ['leak', 'reduction', 'over_darkening', 'peter_panning'];

function nameOf(series) {
  return series === 'error' ? 'Error' : kit.causeLabel[series] || series;
}
function colourOf(series) {
  return series === 'error' ? 'var(--ink)' : 'var(--c-' + series + ')';
}
function phraseOf(point) {
  return [point.part, point.phrase].filter(Boolean).join(': ') || 'Point ' + point.id;
}

var stops, self = kit.chart('reduction', function(width) {
  var point = kit.byId[id], curve = point.reductions, values = curve.value, metrics = point.metrics;
  var left = 76, right = 16, w = width - left - right, h = width < 520 ? 260 : 340;
  var series = ['error'].concat(causes).filter(function(s) {
    return curve[s].some(function(v) {
      return v > 0;
    });
  });
  if (!series.length) {
    self.plot.append(kit.make('p', {class: 'small'}, 'The value is 0 at every reduction.'));
    return null;
  }
  // Four decades below the largest value; smaller ones are drawn on the axis.
  var top = 1.3 * Math.max.apply(null, series.map(function(s) {
    return Math.max.apply(null, curve[s]);
  })), bottom = top / 1e4, rows = [];
  series.forEach(function(s) {
    values.forEach(function(r, i) {
      var v = curve[s][i];
      rows.push({series: s, r: r, v: Math.max(v, bottom), colour: colourOf(s), dash: dashes[s] || [1, 0]});
    });
  });
  var marks = [], from = metrics.reduction_min, to = metrics.reduction_max;
  if (kit.finite(from))
    marks.push({
      type: 'rect',
      interactive: false,
      encode: {
        enter: {
          x: {scale: 'x', value: from},
          x2: {scale: 'x', value: to},
          y: {value: 0},
          y2: {value: h},
          fill: {value: 'var(--good)'},
          fillOpacity: {value: 0.12}
        }
      }
    });
  marks.push({
    type: 'group',
    from: {facet: {name: 'one', data: 'rows', groupby: 'series'}},
    marks: [{
      type: 'line',
      from: {data: 'one'},
      interactive: false,
      encode: {
        enter: {
          x: {scale: 'x', field: 'r'},
          y: {scale: 'y', field: 'v'},
          stroke: {field: 'colour'},
          strokeDash: {field: 'dash'},
          strokeWidth: {value: 1.9}
        }
      }
    }]
  });
  [[metrics.best_reduction, 'least error', 'var(--good)', 0], [curve.as_set, 'as set', 'var(--accent)', 1]].forEach(
      function(m) {
        if (!kit.finite(m[0])) return;
        var flip = m[0] > 0.7;
        marks.push({
          type: 'rule',
          interactive: false,
          encode: {
            enter: {
              x: {scale: 'x', value: m[0]},
              y: {value: 0},
              y2: {value: h},
              stroke: {value: m[2]},
              strokeWidth: {value: 1.5}
            }
          }
        });
        marks.push({
          type: 'text',
          interactive: false,
          encode: {
            enter: {
              x: {scale: 'x', value: m[0]},
              y: {value: 14 + 16 * m[3]},
              dx: {value: flip ? -5 : 5},
              align: {value: flip ? 'right' : 'left'},
              text: {value: m[1]},
              fill: {value: m[2]},
              fontWeight: {value: 600}
            }
          }
        });
      });
  marks.push({
    type: 'rule',
    interactive: false,
    encode: {
      update: {
        x: {signal: 'hover'},
        y: {value: 0},
        y2: {value: h},
        stroke: {value: 'var(--soft)'},
        opacity: {signal: 'hover < 0 ? 0 : 0.6'}
      }
    }
  });
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
        {name: 'y', type: 'log', zero: false, domain: [bottom, top], range: [h, 0]}
      ],
      axes: [
        {
          orient: 'left',
          scale: 'y',
          grid: true,
          domain: false,
          ticks: false,
          values: kit.logTicks(bottom, top),
          title: 'share of counted receivers',
          encode: {labels: {update: {text: {signal: kit.axisLabel('fraction')}}}}
        },
        {orient: 'bottom', scale: 'x', tickCount: 10, title: 'lookup.reduction'}
      ],
      marks: marks
    },
    hover: function(view, plot) {
      var svg = plot.querySelector('svg'), x = view.scale('x');
      stops = function() {
        var box = svg.getBoundingClientRect();
        return values.map(function(r) {
          return {element: svg, x: box.left + left + x(r), y: box.top + box.height / 3};
        });
      };
      svg.addEventListener('mousemove', function(event) {
        var r = x.invert(event.clientX - svg.getBoundingClientRect().left - left), i = 0;
        values.forEach(function(v, j) {
          if (Math.abs(v - r) < Math.abs(values[i] - r)) i = j;
        });
        view.signal('hover', x(values[i])).run();
        kit.showTip(
            event, ['error'].concat(causes).map(function(s) {
              return [nameOf(s), kit.shown(curve[s][i], 'fraction'), s === 'error' ? '' : s];
            }),
            'reduction ' + kit.digits(values[i]));
      });
      svg.addEventListener('mouseleave', function() {
        kit.hideTip();
        view.signal('hover', -1).run();
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
  if (curved.length > 1)
    self.controls.append(kit.picker(
        'Point', curved.map(function(p) {
          return [p.id, phraseOf(p)];
        }),
        id, function(v) {
          page.select(+v);
        }));
}
['error'].concat(causes).forEach(function(s) {
  var mark = kit.make('span');
  if (s === 'error')
    mark.innerHTML = '<svg viewBox="0 0 26 10" aria-hidden="true"><line x1="0" x2="26" y1="5" y2="5" ' +
        'stroke="var(--ink)" stroke-width="1.5" stroke-dasharray="5 3"/></svg>';
  else
    mark.append(kit.make('i', {class: 'sw c-' + s}));
  mark.append(s === 'error' ? 'Error, mean |R4 − R1|' : nameOf(s));
  self.legend.append(mark);
});
page.onSelect.push(function(chosen) {
  if (!kit.byId[chosen].reductions) return;
  id = chosen;
  controls();
  self.draw();
});
controls();
})();
