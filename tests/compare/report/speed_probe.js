// Runs in the report's page after its own scripts (tests/compare/report/page_test.cpp). It uses the chart of cost against
// error as a reader does and writes its observations to the element `probe`.
(async function() {
  'use strict';
  var saw = {errors: errors}, figure = document.getElementById('chart-cost'), plot = figure.querySelector('.plot');
  function all(selector, root) {
    return Array.prototype.slice.call((root || figure).querySelectorAll(selector));
  }
  function later() {
    return new Promise(function(go) {
      setTimeout(go, 0);
    });
  }
  function texts(selector) {
    return all(selector).map(function(e) {
      return e.textContent;
    });
  }
  function choices() {
    return all('.choice-marks path');
  }
  function datum(path) {
    return path.__data__.datum;
  }
  // The rows of all marks, also of those that share one.
  function all_rows() {
    return choices().reduce(function(list, p) {
      return list.concat([datum(p)], datum(p).others);
    }, []);
  }
  function observe() {
    return {
      choices: choices().reduce(function(sum, p) {
        return sum + 1 + datum(p).others.length;
      }, 0),
      crosses: all_rows()
                   .filter(function(r) {
                     return !r.counts;
                   })
                   .length,
      bars: all('.span-bars line').length,
      cost_bars: all('.cost-bars line').length,
      rings: all('.answers-ring path').length,
      labels: texts('.answer-names text'),
      zeros: texts('.mark-text.role-mark text')
                 .filter(function(t) {
                   return t === '0';
                 })
                 .length,
      titles: texts('.role-axis-title text'),
      shapes: all_rows()
                  .map(function(r) {
                    return r.shape;
                  })
                  .filter(function(s, i, list) {
                    return list.indexOf(s) === i;
                  })
                  .length
    };
  }
  // The names on the drawn front, from the cheapest.
  function front() {
    return window.noonmarkPage.kit.drawn
        .filter(function(chart) {
          return chart.figure === figure;
        })[0]
        .view.data('front')
        .filter(function(row) {
          return row.entry;
        })
        .map(function(row) {
          return row.entry.name_at_bias;
        });
  }
  async function set(label, value) {
    var select = all('.controls label')
                     .filter(function(l) {
                       return l.textContent.indexOf(label) === 0;
                     })[0]
                     .querySelector('select');
    if (value !== undefined) {
      select.value = value;
      select.dispatchEvent(new Event('change'));
      await later();
    }
    return select.options.length;
  }
  function selected() {
    return Array.prototype.map.call(document.querySelectorAll('tr.selected'), function(row) {
      return +row.dataset.point;
    });
  }
  // Where a mark stands, in pixels of the window.
  function places() {
    return choices().map(function(p) {
      var box = p.getBoundingClientRect();
      return [box.left + box.width / 2, box.top + box.height / 2];
    });
  }

  saw.first = observe();
  // All cost the same here.
  saw.at_one_cost = Math.max.apply(null, places().map(function(p) {
    return p[0];
  })) - Math.min.apply(null, places().map(function(p) {
    return p[0];
  }));
  saw.apart = places().every(function(a, i, list) {
    return list.every(function(b, j) {
      return i === j || Math.abs(a[1] - b[1]) > 8;
    });
  });
  saw.counts = texts('.counts text').filter(Boolean);
  saw.shared = choices()
                   .map(function(p) {
                     return datum(p).others.length;
                   })
                   .filter(Boolean)
                   .map(function(n) {
                     return '+' + n;
                   });
  // Axes of large numbers.
  saw.ticks = texts('.role-axis-label text');
  saw.words = figure.querySelector('.facts').textContent;
  saw.legend = figure.querySelector('.legend').textContent;
  saw.options =
      {compare: await set('Compare'), cost: await set('Cost'), error: await set('Error'), shape: await set('Shape')};

  // The bar over the usable window is that of the choice that is described.
  window.noonmarkPage.select(all_rows().filter(function(r) {
    return r.span;
  })[0].id);
  await later();
  saw.bars_of_selected = observe().bars;
  // Once it is selected, a choice that shared a mark is the first of it.
  window.noonmarkPage.select(18);
  await later();
  var target = choices().filter(function(p) {
    return datum(p).id === 18;
  })[0];
  target.dispatchEvent(new MouseEvent('mousemove', {bubbles: true, clientX: 300, clientY: 300, view: window}));
  saw.tip = document.getElementById('tip').textContent;
  target.dispatchEvent(new MouseEvent('click', {bubbles: true, cancelable: true, view: window}));
  await later();
  saw.clicked = selected();
  saw.chosen_rings = all('.chosen-ring path').length;
  saw.picture = all('.beside img').length;
  saw.clicked_words = figure.querySelector('.facts').textContent;
  var order = all_rows()
                  .sort(function(a, b) {
                    return a.px - b.px || a.v - b.v;
                  })
                  .map(function(d) {
                    return d.id;
                  });
  plot.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowRight', bubbles: true, cancelable: true}));
  await later();
  saw.next = order[order.indexOf(18) + 1];
  saw.by_key = selected();

  await set('Error', 'error_soft');
  saw.soft = observe();
  saw.soft_note = figure.querySelector('p.small').textContent;
  await set('Error', 'error');
  await set('Cost', 'map_ms');
  saw.map_ms = observe();
saw.map_ms_legend = figure.querySelector('.legend').textContent;
saw.map_ms_words = figure.querySelector('.facts').textContent;
saw.map_ms_front = front();
  await set('Shape', '2');
  saw.by_resolution = observe();
  await set('Compare', '1');
  saw.other = observe();
  saw.width = document.documentElement.scrollWidth <= innerWidth;

  leave(saw);
})();
