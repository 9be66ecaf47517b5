// Error against bias for one point. Causes are lines or stacked areas, the usable window is shaded, and 0 stands apart
// from the logarithmic axis.
(function() {
'use strict';
var page = window.noonmarkPage, kit = page.kit, data = page.data;
var curved = data.points.filter(function(p) {
  return p.curve;
});
var state = {unit: 'depth', view: 'lines', id: null};
// What has a band over the placements of the map's grid (map.placements), on the exact map.
var banded = ['error', 'acne', 'peter_panning', 'aliasing'];
var series = ['acne', 'peter_panning', 'aliasing_dark', 'aliasing_light', 'coverage'];
if (!curved.length) return;
var recommended = kit.byId[data.recommended];
state.id = recommended && recommended.curve ? recommended.id : curved[0].id;

function factor(curve) {
  return state.unit === 'm' ? curve.m_per_depth : state.unit === 'texels' ? curve.texels_per_depth : 1;
}

function hasBands(curve) {
  return curve.placements > 1 && curve.error_worst !== undefined;
}

function build(width) {
  var curve = kit.byId[state.id].curve, k = factor(curve), bias = curve.bias_depth.map(function(b) {
    return b * k;
  });
  var positive = bias.filter(function(b) {
    return b > 0;
  });
  if (!positive.length) return null;
  var left = 64, right = 14, plotWidth = width - left - right, height = width < 520 ? 260 : 340, gap = 64;
  var low = positive[0], high = positive[positive.length - 1];
  var lines = ['error'].concat(series).filter(function(s) {
    return curve[s].some(function(v) {
      return v > 0;
    });
  });
  var all = [];
  lines.forEach(function(s) {
    curve[s].forEach(function(v) {
      if (v > 0) all.push(v);
    });
  });
  var bands = hasBands(curve) ? banded.filter(function(s) {
    return curve[s + '_worst'].some(function(v) {
      return v > 0;
    });
  }) :
                                [];
  bands.forEach(function(s) {
    curve[s + '_worst'].forEach(function(v) {
      if (v > 0) all.push(v);
    });
  });
  var bounds = [curve.acne_bound, curve.peter_panning_bound].filter(function(v) {
    return v > 0;
  });
  // Smaller values are drawn on the axis.
  var range = kit.curve.range(all.concat(bounds)), top = range.top, bottom = range.bottom,
      stacked = state.view === 'stacked';
  var rows = [], stack = [];
  bias.forEach(function(b, i) {
    (stacked ? ['error'] : lines).forEach(function(s) {
      var v = curve[s][i];
      if (!kit.finite(v)) return;
      if (!stacked && !kit.curve.onAxis(curve[s], i, bottom, b > 0)) return;
      rows.push({b: b, s: s, v: stacked ? v : Math.max(v, bottom)});
    });
    var sum = 0;
    series.forEach(function(s) {
      var v = kit.finite(curve[s][i]) ? curve[s][i] : 0;
      stack.push({b: b, s: s, v0: sum, v1: sum + v});
      sum += v;
    });
    if (stacked)
      top = Math.max(i ? top : 0, sum * 1.04, (kit.finite(curve.error[i]) ? curve.error[i] : 0) * 1.04, 1e-9);
  });
  // A band from the least to the largest over the placements, and the mean in it. On the axis where it is 0.
  var band = [];
  if (!stacked)
    bias.forEach(function(b, i) {
      bands.forEach(function(s) {
        function within(v) {
          return Math.max(v, bottom);
        }
        band.push({
          b: b,
          s: s,
          low: within(curve[s + '_best'][i]),
          high: within(curve[s + '_worst'][i]),
          mean: within(curve[s + '_mean'][i])
        });
      });
    });
  function at(b) {
    return b > 0 ? {scale: 'x', value: Math.min(Math.max(b, low), high)} : {value: 12};
  }
  var marks = [];
  if (curve.window_min_depth !== undefined) {
    marks.push(kit.curve.window(at(curve.window_min_depth * k), at(curve.window_max_depth * k), height));
    marks.push({
      type: 'text',
      encode: {
        enter: {
          x: at(Math.max(Math.sqrt(Math.max(curve.window_min_depth * k, low) * curve.window_max_depth * k), low)),
          y: {value: 14},
          align: {value: 'center'},
          text: {value: 'usable'},
          fill: {value: 'var(--good)'},
          fontWeight: {value: 600}
        }
      }
    });
  }
  if (hasBands(curve) && curve.window_min_worst_depth !== undefined)
    marks.push(Object.assign(
        kit.curve.window(at(curve.window_min_worst_depth * k), at(curve.window_max_worst_depth * k), height),
        {name: 'every'}));
  if (!stacked)
    marks = marks.concat(kit.curve.bounds(
        [[curve.acne_bound, 'acne bound'], [curve.peter_panning_bound, 'Peter Panning bound']], plotWidth, gap));
  var strokeOf = {signal: 'datum.s === \'error\' ? \'var(--ink)\' : \'var(--c-\' + datum.s + \')\''};
  if (stacked)
    marks.push({
      type: 'rect',
      from: {data: 'stack0'},
      encode: {
        enter: {
          x: {value: 5},
          x2: {value: 19},
          y: {scale: 'y', field: 'v1'},
          y2: {scale: 'y', field: 'v0'},
          fill: {signal: '\'var(--c-\' + datum.s + \')\''}
        }
      }
    });
  if (stacked)
    marks.push({
      type: 'group',
      from: {facet: {name: 'f', data: 'stack1', groupby: 's'}},
      marks: [{
        type: 'area',
        from: {data: 'f'},
        encode: {
          enter: {
            x: {scale: 'x', field: 'b'},
            y: {scale: 'y', field: 'v1'},
            y2: {scale: 'y', field: 'v0'},
            fill: {signal: '\'var(--c-\' + datum.s + \')\''},
            interpolate: {value: 'linear'}
          }
        }
      }]
    });
  if (band.length) {
    marks.push({
      type: 'group',
      from: {facet: {name: 'bands', data: 'band', groupby: 's'}},
      marks: [
        {
          type: 'area',
          from: {data: 'bands'},
          interactive: false,
          encode: {
            enter: {
              x: {scale: 'x', field: 'b'},
              y: {scale: 'y', field: 'high'},
              y2: {scale: 'y', field: 'low'},
              fill: strokeOf,
              fillOpacity: {signal: 'datum.s === \'error\' ? 0.14 : 0.26'}
            }
          }
        },
        {
          type: 'line',
          from: {data: 'bands'},
          interactive: false,
          encode: {
            enter: {
              x: {scale: 'x', field: 'b'},
              y: {scale: 'y', field: 'mean'},
              stroke: strokeOf,
              strokeWidth: {value: 1.1},
              strokeDash: {value: [1.5, 2.5]}
            }
          }
        }
      ]
    });
    marks.push({
      type: 'rule',
      from: {data: 'band0'},
      interactive: false,
      encode: {
        enter: {
          x: {value: 12},
          y: {scale: 'y', field: 'low'},
          y2: {scale: 'y', field: 'high'},
          stroke: strokeOf,
          strokeWidth: {value: 9},
          strokeOpacity: {value: 0.26}
        }
      }
    });
  }
  marks.push({
    type: 'group',
    from: {facet: {name: 'g', data: 'positive', groupby: 's'}},
    marks: [{
      type: 'line',
      from: {data: 'g'},
      interactive: false,
      encode: {
        enter: {
          x: {scale: 'x', field: 'b'},
          y: {scale: 'y', field: 'v'},
          stroke: strokeOf,
          strokeJoin: {value: 'round'},
          strokeWidth: {signal: 'datum.s === \'error\' ? 1.5 : 2.4'},
          strokeDash: {signal: 'datum.s === \'error\' ? [' + kit.curve.errorDash + '] : [1,0]'},
          strokeOpacity: {value: 1}
        }
      }
    }]
  });
  marks.push({
    type: 'rule',
    encode: {
      enter: {
        x: {value: gap - 30},
        x2: {value: gap - 30},
        y: {value: 0},
        y2: {value: height},
        stroke: {value: 'var(--rule)'},
        strokeDash: {value: [2, 3]}
      }
    }
  });
  marks.push({
    type: 'symbol',
    from: {data: 'zero'},
    encode: {enter: {x: {value: 12}, y: {scale: 'y', field: 'v'}, fill: strokeOf, size: {value: 58}}}
  });
  marks.push({
    type: 'text',
    encode: {
      enter: {
        x: {value: 12},
        y: {value: height + 9},
        align: {value: 'center'},
        baseline: {value: 'top'},
        text: {value: '0'}
      }
    }
  });
  [[curve.best_bias_depth, 'best', 0], [curve.set_bias_depth, 'as set', 1]].forEach(function(m) {
    if (!kit.finite(m[0])) return;
    var b = m[0] * k, beyond = b > high;
    // The name of the lesser bias stands on its left, that of the greater on its right, unless an edge is near.
    var place = Math.log(Math.min(Math.max(b, low), high) / low) / Math.log(high / low),
        other = m[2] ? curve.best_bias_depth : curve.set_bias_depth;
    var side = place > 0.9 ? -1 : place < 0.1 ? 1 : kit.finite(other) && m[0] < other ? -1 : 1;
    marks = marks.concat(kit.curve.mark(at(b), m[1] + (beyond ? ' (beyond)' : ''), m[2], side, height));
  });
  marks.push(kit.curve.cursor(height));
  return {
    spec: {
      width: plotWidth,
      height: height,
      padding: {left: left, right: right, top: 6, bottom: 46},
      autosize: 'none',
      signals: [{name: 'hover', value: -1}],
      data: [
        {name: 'rows', values: rows},
        {name: 'positive', source: 'rows', transform: [{type: 'filter', expr: 'datum.b > 0'}]},
        {name: 'zero', source: 'rows', transform: [{type: 'filter', expr: 'datum.b <= 0'}]}, {
          name: 'band',
          values: band.filter(function(r) {
            return r.b > 0;
          })
        },
        {
          name: 'band0',
          values: band.filter(function(r) {
            return r.b <= 0;
          })
        },
        {
          name: 'stack0',
          values: stack.filter(function(r) {
            return r.b <= 0;
          })
        },
        {
          name: 'stack1',
          values: stack.filter(function(r) {
            return r.b > 0;
          })
        }
      ],
      scales: [
        {name: 'x', type: 'log', domain: [low, high], range: [gap, plotWidth], zero: false},
        stacked ? {name: 'y', type: 'linear', domain: [0, top], range: [height, 0]} :
                  {name: 'y', type: 'log', domain: [bottom, top], range: [height, 0], zero: false}
      ],
      axes: [
        kit.curve.axis(stacked ? undefined : range), {
          orient: 'bottom',
          scale: 'x',
          grid: false,
          values: kit.logTicks(low, high).filter(function(v) {
            return width > 600 || /^1(0*|e.*)$/.test(String(v).replace(/^0?\.?0*/, ''));
          }),
          labelOverlap: true,
          labelSeparation: 6,
          title: curve.parameter + ' (' + state.unit + ')',
          encode: {labels: {update: {text: {signal: kit.axisLabel('')}}}}
        }
      ],
      marks: marks
    },
    hover: function(view, plot) {
      // Where the pointer would stand for bias i: biases of 0 are left of the gap.
      function place(i) {
        return bias[i] > 0 ? view.scale('x')(bias[i]) : 12;
      }
      stops = kit.curve.hover(view, plot, {
        left: left,
        count: bias.length,
        place: place,
        nearest: function(px) {
          if (px <= gap - 30) return 0;
          var i = 0, b = view.scale('x').invert(Math.min(Math.max(px, gap), plotWidth));
          for (var j = 1; j < bias.length; ++j)
            if (bias[j] > 0 && (bias[i] <= 0 || Math.abs(Math.log(bias[j] / b)) < Math.abs(Math.log(bias[i] / b))))
              i = j;
          return i;
        },
        tip: function(i) {
          return {
            rows: ['error']
                      .concat(series)
                      .map(function(s) {
                        return [kit.curve.nameOf(s), kit.shown(curve[s][i], 'fraction'), s === 'error' ? '' : s];
                      })
                      .concat(hasBands(curve) ? bandRows(curve, i) : []),
            title: three(curve.bias_depth[i], curve)
          };
        }
      });
    }
  };
}

// "Acne: least, mean, largest over 64 placements".
function bandRows(curve, i) {
  return [['Over ' + curve.placements + ' placements', 'least · mean · largest']].concat(banded.map(function(s) {
    return [
      kit.curve.nameOf(s),
      ['_best', '_mean', '_worst']
          .map(function(e) {
            return kit.shown(curve[s + e][i], 'fraction');
          })
          .join(' · '),
      s === 'error' ? '' : s
    ];
  }));
}

var stops, self = kit.chart('bias', build);
if (self)
  kit.keyboard(self, function() {
    return stops ? stops() : [];
  });
if (!self) return;
var facts = kit.make('p', {class: 'facts'});
self.legend.before(facts);
function three(depth, curve) {
  return kit.digits(depth) + ' depth = ' + kit.digits(depth * curve.m_per_depth) +
      ' m = ' + kit.digits(depth * curve.texels_per_depth) + ' texels';
}
function describe() {
  var point = kit.byId[state.id], curve = point.curve;
  facts.textContent = '';
  if (curve.window_min_depth !== undefined)
    facts.append(
        'Usable from ', kit.make('b', {}, three(curve.window_min_depth, curve)), ' to ',
        kit.make('b', {}, three(curve.window_max_depth, curve)), '. ');
  else
    facts.append(kit.make('b', {style: 'color:var(--bad)'}, point.no_window ? 'The usable window is ' + point.no_window + '. ' : 'No usable window: no bias is good enough. '));
  if (hasBands(curve) && !point.no_window) {
    if (curve.window_min_worst_depth !== undefined)
      facts.append(
          'At every one of ' + curve.placements + ' placements of the grid from ',
          kit.make('b', {}, three(curve.window_min_worst_depth, curve)), ' to ',
          kit.make('b', {}, three(curve.window_max_worst_depth, curve)), '. ');
    else
      facts.append(kit.make(
          'b', {style: 'color:var(--bad)'},
          'No bias is good enough at every one of ' + curve.placements + ' placements of the grid. '));
  }
  facts.append(
      'Best at ' + three(curve.best_bias_depth, curve) + ', with ' + kit.shown(curve.best_error, 'fraction') +
      ' error. Made: ' + curve.made + '.');
}
function legend() {
  self.legend.textContent = '';
  series.forEach(function(s) {
    self.legend.append(kit.curve.key(s));
  });
  self.legend.append(kit.curve.key('error', 'Error, mean |R5 − R1|', kit.curve.errorDash));
  if (!curved.some(function(p) {
        return hasBands(p.curve);
      }))
    return;
  var band = kit.make('span');
  band.innerHTML = '<svg viewBox="0 0 26 10" aria-hidden="true"><rect width="26" height="10" fill="var(--c-acne)" ' +
      'fill-opacity=".26"/><line x1="0" x2="26" y1="5" y2="5" stroke="var(--c-acne)" stroke-width="1.1" ' +
      'stroke-dasharray="1.5 2.5"/></svg>';
  band.append('least to largest over the placements of the grid, and their mean');
  self.legend.append(band);
}
function controls() {
  self.controls.textContent = '';
  var parts = curved[0].part !== undefined;
  // Parts differ in more than the swept settings, so there a point is chosen by its name.
  if (parts && curved.length > 1) self.controls.append(kit.pointPicker(curved, state.id));
  data.swept
      .filter(function(s) {
        return !parts && s.values.length > 1;
      })
      .forEach(function(s) {
        self.controls.append(kit.picker(
            s.label, s.values.map(function(v) {
              return [v, kit.valueText(s, v) + (s.unit && s.unit !== 'bias.unit' ? kit.thin + s.unit : '')];
            }),
            kit.byId[state.id].settings[s.name], function(v) {
              var wanted = Object.assign({}, kit.byId[state.id].settings);
              wanted[s.name] = v;
              // The point with these settings. In an incomplete sweep, the point that shares most of them.
              var best = null, most = -1;
              curved.forEach(function(p) {
                var n = data.swept.reduce(function(sum, t) {
                  return sum + (p.settings[t.name] === wanted[t.name] ? (t === s ? 100 : 1) : 0);
                }, 0);
                if (n > most) {
                  most = n;
                  best = p;
                }
              });
              page.select(best.id);
            }));
      });
  self.controls.append(kit.segments([['depth', 'depth'], ['m', 'm'], ['texels', 'texels']], state.unit, function(u) {
    state.unit = u;
    self.draw();
  }));
  self.controls.append(kit.segments([['lines', 'Lines'], ['stacked', 'Stacked']], state.view, function(v) {
    state.view = v;
    self.draw();
  }));
}
page.onSelect.push(function(id) {
  if (!kit.byId[id].curve) return;
  state.id = id;
  controls();
  describe();
  self.draw();
});
controls();
legend();
describe();
})();
