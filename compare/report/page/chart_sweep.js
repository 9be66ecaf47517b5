// Error against each swept number.
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
      apart = kit.tellApart(others);
  var measure = data.speed.error;
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
          kit.measureAxis(floor, measure), {
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
  kit.keyboard(self);
}
var index = 0;
data.swept.forEach(function(s) {
  if (s.numeric && s.values.length > 1) sweepChart(s, ++index);
});
})();
