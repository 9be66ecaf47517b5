// Measured against predicted, with one sign for each sample of the chosen law.
(function() {
'use strict';
var page = window.noonmarkPage, kit = page.kit, laws = page.data.laws;
if (!laws || !laws.length) return;
var chosen = 0;

var self = kit.chart('laws', function(width) {
  var law = laws[chosen], left = 72, right = 18, w = width - left - right, h = width < 520 ? 280 : 380;
  var rows = law.samples.map(function(s) {
    return {p: s.predicted, m: s.measured, allowed: s.allowed, point: s.point};
  });
  function ends(list) {
    var all = [];
    list.forEach(function(r) {
      all.push(r.p, r.m);
    });
    return [Math.min.apply(null, all), Math.max.apply(null, all)];
  }
  // Values that span more than a decade are drawn on logarithmic axes, without the zeros.
  var above = rows.filter(function(r) {
    return r.p > 0 && r.m > 0;
  });
  var range = ends(rows), log = above.length > 1 && range[0] >= 0 && ends(above)[1] > 10 * ends(above)[0];
  var zeros = log ? rows.length - above.length : 0;
  if (log) {
    rows = above;
    range = ends(above);
  }
  var low = range[0], high = range[1];
  if (log) {
    low /= 1.25;
    high *= 1.25;
  } else {
    var room = (high - low || 1) * 0.05;
    low -= room;
    high += room;
  }
  function scale(name, range) {
    return {name: name, type: log ? 'log' : 'linear', domain: [low, high], range: range, nice: false, zero: false};
  }
  function axis(orient, name, title) {
    return {
      orient: orient,
      scale: name,
      title: title,
      grid: true,
      values: log ? kit.logTicks(low, high) : undefined,
      tickCount: 6,
      encode: {labels: {update: {text: {signal: kit.axisLabel('')}}}}
    };
  }
  var quantity = law.measured.length > 40 ? 'measured' : law.measured;
  return {
    measure: 'error',
    spec: {
      width: w,
      height: h,
      padding: {left: left, right: right, top: 10, bottom: 46},
      autosize: 'none',
      data: [{name: 'rows', values: rows}],
      scales: [scale('x', [0, w]), scale('y', [h, 0])],
      axes: [
        axis('bottom', 'x', 'predicted ' + quantity + (zeros ? ' (' + zeros + ' samples of 0 are not drawn)' : '')),
        axis('left', 'y', 'measured ' + quantity)
      ],
      marks: [
        {
          type: 'rule',
          encode: {
            enter: {
              x: {scale: 'x', value: low},
              x2: {scale: 'x', value: high},
              y: {scale: 'y', value: low},
              y2: {scale: 'y', value: high},
              stroke: {value: 'var(--good)'},
              strokeWidth: {value: 1.5}
            }
          }
        },
        {
          type: 'symbol',
          from: {data: 'rows'},
          encode: {
            enter: {
              x: {scale: 'x', field: 'p'},
              y: {scale: 'y', field: 'm'},
              size: {value: 42},
              fill: {value: 'transparent'},
              stroke: {value: 'var(--c-peter_panning)'},
              strokeWidth: {value: 1.4}
            },
            hover: {size: {value: 110}},
            update: {size: {value: 42}}
          }
        }
      ]
    },
    hover: function(view) {
      view.addEventListener('mousemove', function(event, item) {
        var d = item && item.datum;
        if (!d || d.point === undefined) return kit.hideTip();
        var p = kit.byId[d.point];
        kit.showTip(
            event,
            [
              ['predicted', kit.digits(d.p)], ['measured', kit.digits(d.m)], ['ratio', kit.digits(d.m / d.p)],
              ['largest difference allowed', kit.digits(d.allowed)]
            ],
            'Point ' + d.point + (p && p.phrase ? ': ' + p.phrase : ''));
      });
      view.addEventListener('click', function(event, item) {
        if (item && item.datum && item.datum.point !== undefined) page.open(item.datum.point);
      });
    }
  };
});
if (self) kit.keyboard(self);
if (self && laws.length > 1)
  self.controls.append(kit.picker(
      'Law', laws.map(function(l, i) {
        return [i, l.name];
      }),
      0, function(v) {
        chosen = +v;
        self.draw();
      }));
})();
