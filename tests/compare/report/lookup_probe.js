// Runs in the page of a filtered map after its own scripts (tests/compare/report/page_test.cpp). It reads the charts over the
// reduction and, where there is one, over another setting of the lookup, the switch of the page and the card of a point, and
// writes them to the element `probe`.
(async () => {
  'use strict';
  const page = window.noonmarkPage, saw = {errors};
  function chosen(id) {  // and drawn
    page.select(id);
    return later();
  }
  const textOf = e => e.textContent;
  // The dashes of the lines as drawn, and of the legend's, by their colour and thickness.
  function look(line) {
    return [
      line.getAttribute('stroke'), line.getAttribute('stroke-width'),
      (line.getAttribute('stroke-dasharray') || '').replace(/,/g, ' ')
    ].join('; ');
  }
  function readerOf(name) {
    const figure = document.getElementById('chart-' + name);
    if (!figure) return null;
    const all = selector => Array.from(figure.querySelectorAll(selector));
    const rows = () => page.kit.drawn.find(one => one.figure === figure).view.data('rows');
    return {
      now: function() {
        return {
          facts: figure.querySelector('.facts').textContent,
          windows: all('.mark-rect.role-mark path').length,
          bounds: all('.mark-rule.bound line').length,
          title: all('.role-axis-title text').map(textOf),
          labels: all('.role-axis-label text').map(textOf),
          words: all('.mark-text.role-mark text').map(textOf),
          series: Array.from(new Set(rows().map(row => row.series))),
          error: rows().filter(row => row.series === 'error').map(row => row.v),
          zeros: rows().filter(row => row.series === 'leak' && row.value >= 0.3).length
        };
      },
      once: function() {
        return {
          points: all('.controls option').map(textOf),
          drawn: all('.mark-line path').map(look),
          legend: all('.legend > span')
                      .filter(e => e.querySelector('line'))
                      .map(e => [e.textContent, look(e.querySelector('line'))])
        };
      }
    };
  }
  const charts = {reduction: readerOf('reduction'), over: readerOf('over')};
  saw.choice = document.querySelector('.bias-choice').firstChild.textContent;
  for (const id of [0, 1, 2]) {
    await chosen(id);
    for (const [name, chart] of Object.entries(charts)) {
      if (!chart) continue;
      if (!id) saw[name] = Object.assign(chart.once(), {at: []});
      saw[name].at.push(chart.now());
    }
  }
  page.open(1, 'recommended');
  const card = document.querySelector('dialog');
  saw.verdict = card.textContent;
  saw.command = card.querySelector('.command').textContent;
  leave(saw);
})();
