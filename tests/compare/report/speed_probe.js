// Runs in the report's page after its own scripts (tests/compare/report/page_test.cpp). It uses the chart of cost against
// error as a reader does and writes its observations to the element `probe`.
(async () => {
  'use strict';
  const saw = {errors}, figure = document.getElementById('chart-cost'), plot = figure.querySelector('.plot');
  const all = (selector, root) => Array.from((root || figure).querySelectorAll(selector));
  const texts = selector => all(selector).map(e => e.textContent);
  const choices = () => all('.choice-marks path');
  const datum = path => path.__data__.datum;
  // The rows of all marks, also of those that share one.
  const all_rows = () => choices().reduce((list, p) => list.concat([datum(p)], datum(p).others), []);
  const observe = () => ({
    choices: choices().reduce((sum, p) => sum + 1 + datum(p).others.length, 0),
    crosses: all_rows().filter(r => !r.counts).length,
    bars: all('.span-bars line').length,
    cost_bars: all('.cost-bars line').length,
    rings: all('.answers-ring path').length,
    labels: texts('.answer-names text'),
    zeros: texts('.mark-text.role-mark text').filter(t => t === '0').length,
    titles: texts('.role-axis-title text'),
    shapes: all_rows().map(r => r.shape).filter((s, i, list) => list.indexOf(s) === i).length
  });
  // The names on the drawn front, from the cheapest.
  const front = () => window.noonmarkPage.kit.drawn.filter(chart => chart.figure === figure)[0]
                          .view.data('front')
                          .filter(row => row.entry)
                          .map(row => row.entry.name_at_bias);
  async function set(label, value) {
    const select = all('.controls label').filter(l => l.textContent.indexOf(label) === 0)[0].querySelector('select');
    if (value !== undefined) {
      select.value = value;
      select.dispatchEvent(new Event('change'));
      await later();
    }
    return select.options.length;
  }
  const selected = () => Array.from(document.querySelectorAll('tr.selected'), row => +row.dataset.point);
  // Where a mark stands, in pixels of the window.
  function places() {
    return choices().map(p => {
      const box = p.getBoundingClientRect();
      return [box.left + box.width / 2, box.top + box.height / 2];
    });
  }

  saw.first = observe();
  // All cost the same here.
  saw.at_one_cost = Math.max.apply(null, places().map(p => p[0])) - Math.min.apply(null, places().map(p => p[0]));
  saw.apart = places().every((a, i, list) => list.every((b, j) => i === j || Math.abs(a[1] - b[1]) > 8));
  saw.counts = texts('.counts text').filter(Boolean);
  saw.shared = choices().map(p => datum(p).others.length).filter(Boolean).map(n => '+' + n);
  // Axes of large numbers.
  saw.ticks = texts('.role-axis-label text');
  saw.words = figure.querySelector('.facts').textContent;
  saw.legend = figure.querySelector('.legend').textContent;
  saw.options =
      {compare: await set('Compare'), cost: await set('Cost'), error: await set('Error'), shape: await set('Shape')};

  // The bar over the usable window is that of the choice that is described.
  window.noonmarkPage.select(all_rows().filter(r => r.span)[0].id);
  await later();
  saw.bars_of_selected = observe().bars;
  // Once it is selected, a choice that shared a mark is the first of it.
  window.noonmarkPage.select(18);
  await later();
  const target = choices().filter(p => datum(p).id === 18)[0];
  target.dispatchEvent(new MouseEvent('mousemove', {bubbles: true, clientX: 300, clientY: 300, view: window}));
  saw.tip = document.getElementById('tip').textContent;
  target.dispatchEvent(new MouseEvent('click', {bubbles: true, cancelable: true, view: window}));
  await later();
  saw.clicked = selected();
  saw.chosen_rings = all('.chosen-ring path').length;
  saw.picture = all('.beside img').length;
  saw.clicked_words = figure.querySelector('.facts').textContent;
  const order = all_rows().sort((a, b) => a.px - b.px || a.v - b.v).map(d => d.id);
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
