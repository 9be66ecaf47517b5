// Error against each swept number, and speed against accuracy.
(function() {
'use strict';
var page = window.noonmarkPage, kit = page.kit, data = page.data;

// The line that the theory predicts: an edge's error is proportional to a texel's size, extent / resolution.
function slopeOf(name) {
  return name === 'map.resolution' ? -1 : name === 'map.extent_m' || name === 'map.extent_scale' ? 1 : 0;
}

function sweepChart(swept, index) {
  var others = data.swept.filter(function(s) {
    return s !== swept;
  }),
      apart = kit.tellApart(others, false);
  var measure = 'error';
  var self = kit.chart('sweep-' + index, function(width) {
    var unit = kit.measureUnit(measure), left = 64, right = 16, w = width - left - right,
        height = width < 520 ? 260 : 320, missing = 0;
    var rows = [];
    data.points.filter(apart.kept).forEach(function(p) {
      var v = kit.value(p, measure), look = apart.of(p);
      if (!kit.finite(v)) ++missing;
      rows.push({
        id: p.id,
        ok: kit.finite(v),
        x: +p.settings[swept.name],
        v: v,
        colour: look.colour,
        dash: look.dash,
        shape: look.shape,
        line: look.line
      });
    });
    var xs = swept.values.map(Number), logX = xs[0] > 0, found = rows.filter(function(r) {
      return r.ok;
    }),
        floor = kit.logFloor(found.map(function(r) {
          return r.v;
        }));
    self.plot.textContent = '';
    if (!floor) {
      self.plot.append(kit.make(
          'p', {class: 'small'}, found.length ? 'The value is 0 at every point.' : 'No point has a finite value.'));
      return null;
    }
    rows.forEach(function(r) {
      r.zero = r.ok && r.v <= 0;
      r.y = !r.ok ? floor.low : r.zero ? floor.zero : r.v;
    });
    rows.sort(function(a, b) {
      return a.x - b.x;
    });
    var marks = [], slope = slopeOf(swept.name), x0 = xs[0], x1 = xs[xs.length - 1];
    if (slope && logX && unit === 'fraction') {
      // The line goes through the geometric mean of the data, from end to end.
      var mean = Math.exp(found.reduce(function(s, r) {
        return s + Math.log(r.y);
      }, 0) / found.length), mid = Math.sqrt(x0 * x1);
      var quarter = Math.sqrt(xs[0] * xs[1]);
      var ends = [x0, x1].map(function(x) {
        return {x: x, y: mean * Math.pow(x / mid, slope)};
      });
      marks.push({
        type: 'line',
        clip: true,
        from: {data: 'guide'},
        encode: {
          enter: {
            x: {scale: 'x', field: 'x'},
            y: {scale: 'y', field: 'y'},
            stroke: {value: 'var(--faint)'},
            strokeDash: {value: [2, 4]},
            strokeWidth: {value: 1.5}
          }
        }
      });
      marks.push({
        type: 'text',
        encode: {
          enter: {
            x: {scale: 'x', value: quarter},
            y: {scale: 'y', value: mean * Math.pow(quarter / mid, slope)},
            dy: {value: -7},
            align: {value: 'center'},
            text: {value: 'slope ' + (slope < 0 ? '−1' : '+1')},
            fill: {value: 'var(--faint)'},
            fontStyle: {value: 'italic'}
          }
        }
      });
      var guide = ends;
    }
    marks.push({
      type: 'group',
      from: {facet: {name: 'f', data: 'rows', groupby: 'line'}},
      marks: [{
        type: 'line',
        from: {data: 'f'},
        interactive: false,
        encode: {
          enter: {
            x: {scale: 'x', field: 'x'},
            y: {scale: 'y', field: 'y'},
            stroke: {field: 'colour'},
            defined: {field: 'ok'},
            strokeDash: {field: 'dash'},
            strokeWidth: {value: 1.9},
            strokeJoin: {value: 'round'}
          }
        }
      }]
    });
    marks.push({
      type: 'symbol',
      from: {data: 'found'},
      encode: {
        enter: {
          x: {scale: 'x', field: 'x'},
          y: {scale: 'y', field: 'y'},
          size: {value: 52},
          shape: {field: 'shape'},
          fill: {signal: 'datum.zero ? \'var(--card)\' : datum.colour'},
          stroke: {field: 'colour'},
          strokeWidth: {value: 1.6}
        },
        hover: {size: {value: 110}},
        update: {size: {value: 52}}
      }
    });
    marks = marks.concat(kit.zeroLabel(floor));
    if (missing)
      marks.push({
        type: 'text',
        encode: {
          enter: {
            x: {value: w},
            y: {value: -6},
            align: {value: 'right'},
            text: {value: missing + ' not finite, left out'},
            fill: {value: 'var(--bad)'}
          }
        }
      });
    var pad = logX ? Math.pow(x1 / x0, 0.03) : 0, span = (x1 - x0) * 0.03;
    return {
      measure: measure,
      spec: {
        width: w,
        height: height,
        padding: {left: left, right: right, top: 18, bottom: 46},
        autosize: 'none',
        data: [
          {name: 'rows', values: rows},
          {name: 'found', source: 'rows', transform: [{type: 'filter', expr: 'datum.ok'}]},
          {name: 'guide', values: guide || []}
        ],
        scales: [
          {
            name: 'x',
            type: logX ? 'log' : 'linear',
            zero: false,
            domain: logX ? [x0 / pad, x1 * pad] : [x0 - span, x1 + span],
            range: [0, w]
          },
          kit.measureScale(floor, height)
        ],
        axes: [
          kit.measureAxis(floor, measure),
          {
            orient: 'bottom',
            scale: 'x',
            values: xs,
            labelOverlap: true,
            title: swept.label + (swept.unit && swept.unit !== 'bias.unit' ? ' (' + swept.unit + ')' : ''),
            encode: {labels: {update: {text: {signal: kit.axisLabel('')}}}}
          }
        ],
        marks: marks
      }
    };
  });
  if (!self) return;
  self.controls.append(kit.picker(
      'Show', kit.measures().map(function(m) {
        return [m, kit.measureLabel(m)];
      }),
      measure, function(m) {
        measure = m;
        self.draw();
      }));
  apart.filters(self);
  apart.legend(self.legend);
}
var index = 0;
data.swept.forEach(function(s) {
  if (s.numeric && s.values.length > 1) sweepChart(s, ++index);
});

function costChart() {
  var apart = kit.tellApart(data.swept, true), measure = 'error';
  var self = kit.chart('cost', function(width) {
    var left = 64, right = 16, w = width - left - right, height = width < 520 ? 280 : 380;
    var rows = [];
    data.points.filter(apart.kept).forEach(function(p) {
      var cost = p.metrics[data.cost], v = kit.value(p, measure), look = apart.of(p);
      if (kit.finite(cost) && kit.finite(v))
        rows.push({
          id: p.id,
          x: cost * (kit.measureUnit(data.cost) === 'bytes' ? 1e-6 : 1),
          v: v,
          colour: look.colour,
          shape: look.shape,
          hollow: look.hollow,
          front: data.pareto[measure].indexOf(p.id) >= 0,
          best: p.id === data.recommended
        });
    });
    var floor = kit.logFloor(rows.map(function(r) {
      return r.v;
    }));
    self.plot.textContent = '';
    if (!rows.length || !floor) {
      self.plot.append(kit.make('p', {class: 'small'}, 'There is nothing to draw.'));
      return null;
    }
    rows.forEach(function(r) {
      r.y = r.v > 0 ? r.v : floor.zero;
    });
    var xs = rows.map(function(r) {
      return r.x;
    }),
        low = Math.min.apply(null, xs), high = Math.max.apply(null, xs), logX = low > 0;
    var front = data.pareto[measure]
                    .map(function(id) {
                      return rows.filter(function(r) {
                        return r.id === id;
                      })[0];
                    })
                    .filter(Boolean);
    var edge = front.length ? front.concat([{x: high * 1.1, y: front[front.length - 1].y}]) : [];
    return {
      measure: measure,
      spec: {
        width: w,
        height: height,
        padding: {left: left, right: right, top: 8, bottom: 46},
        autosize: 'none',
        data: [{name: 'rows', values: rows}, {name: 'edge', values: edge}],
        scales: [
          {
            name: 'x',
            type: logX ? 'log' : 'linear',
            zero: false,
            domain: logX ? [low / 1.1, high * 1.1] : [0, high * 1.05 || 1],
            range: [0, w]
          },
          kit.measureScale(floor, height)
        ],
        axes: [
          kit.measureAxis(floor, measure),
          {
            orient: 'bottom',
            scale: 'x',
            values: logX ? kit.logTicks(low / 1.1, high * 1.1) : undefined,
            labelOverlap: true,
            title: kit.measureLabel(data.cost) + ' (' + (kit.measureUnit(data.cost) === 'bytes' ? 'MB' : kit.measureUnit(data.cost)) + ')',
            encode: {labels: {update: {text: {signal: kit.axisLabel('')}}}}
          }
        ],
        marks: [
          {
            type: 'line',
            from: {data: 'edge'},
            clip: true,
            interactive: false,
            encode: {
              enter: {
                x: {scale: 'x', field: 'x'},
                y: {scale: 'y', field: 'y'},
                interpolate: {value: 'step-after'},
                stroke: {value: 'var(--ink)'},
                strokeWidth: {value: 1.4},
                strokeOpacity: {value: 0.55}
              }
            }
          },
          {
            type: 'symbol',
            from: {data: 'rows'},
            encode: {
              enter: {
                x: {scale: 'x', field: 'x'},
                y: {scale: 'y', field: 'y'},
                shape: {field: 'shape'},
                fill: {signal: 'datum.hollow ? \'var(--card)\' : datum.colour'},
                opacity: {signal: 'datum.front || datum.best ? 1 : 0.6'},
                stroke: {field: 'colour'},
                strokeWidth: {value: 1.9}
              },
              update: {size: {signal: 'datum.front ? 105 : 55'}},
              hover: {size: {value: 150}}
            }
          },
          {
            type: 'symbol',
            from: {data: 'rows'},
            interactive: false,
            encode: {
              enter: {
                x: {scale: 'x', field: 'x'},
                y: {scale: 'y', field: 'y'},
                size: {signal: 'datum.best ? 330 : 0'},
                fill: {value: 'transparent'},
                stroke: {value: 'var(--good)'},
                strokeWidth: {value: 2}
              }
            }
          },
          {
            type: 'text',
            from: {data: 'rows'},
            interactive: false,
            encode: {
              enter: {
                x: {scale: 'x', field: 'x'},
                y: {scale: 'y', field: 'y'},
                dy: {value: -16},
                align: {value: 'center'},
                text: {signal: 'datum.best ? \'recommended\' : \'\''},
                fill: {value: 'var(--good)'},
                fontWeight: {value: 600}
              }
            }
          }
        ].concat(kit.zeroLabel(floor))
      }
    };
  });
  if (!self) return;
  var both = kit.measures().filter(function(m) {
    return m === 'error' || m === 'best_error';
  });
  self.controls.append(kit.segments(
      both.map(function(m) {
        return [m, m === 'error' ? 'Bias as rendered' : 'Best bias'];
      }),
      measure, function(m) {
        measure = m;
        self.draw();
      }));
  apart.filters(self);
  apart.legend(self.legend);
}
costChart();
})();
