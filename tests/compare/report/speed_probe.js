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
  function observe() {
    return {
      choices: choices().length,
      crosses: choices()
                   .filter(function(p) {
                     return p.getAttribute('fill') === 'transparent';
                   })
                   .length,
      bars: all('.span-bars line').length,
      cost_bars: all('.cost-bars line').length,
      rings: all('.best-ring path').length,
      labels: texts('.mark-text text')
                  .filter(function(t) {
                    return t === 'recommended';
                  })
                  .length,
      zeros: texts('.mark-text.role-mark text')
                 .filter(function(t) {
                   return t === '0';
                 })
                 .length,
      titles: texts('.role-axis-title text'),
      shapes: choices()
                  .map(function(p) {
                    return datum(p).shape;
                  })
                  .filter(function(s, i, list) {
                    return list.indexOf(s) === i;
                  })
                  .length
    };
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
  // Where a mark stands, in pixels of the plot.
  function places() {
    return choices().map(function(p) {
      var d = datum(p);
      return [d.px, d.y];
    });
  }

  saw.first = observe();
  saw.apart = places().every(function(a, i, list) {
    return list.every(function(b, j) {
      return i === j || a[0] !== b[0];
    });
  });
  saw.words = figure.querySelector('.facts').textContent;
  saw.legend = figure.querySelector('.legend').textContent;
  saw.options =
      {compare: await set('Compare'), cost: await set('Cost'), error: await set('Error'), shape: await set('Shape')};

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
  var order = choices()
                  .map(datum)
                  .sort(function(a, b) {
                    return a.px - b.px;
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
saw.map_ms_note = figure.querySelector('p.small').textContent;
  await set('Shape', '2');
  saw.by_resolution = observe();
  await set('Compare', '1');
  saw.other = observe();
  saw.width = document.documentElement.scrollWidth <= innerWidth;

  leave(saw);
})();
