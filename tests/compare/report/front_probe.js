// Runs in the report's page after its own scripts (tests/compare/report/page_test.cpp). It reads the curves and the Pareto
// front at both biases of the page, as the chart draws them and as table and words say, and writes them to the element `probe`.
(async () => {
  'use strict';
  const figure = document.getElementById('chart-cost');
  let details;
  // The chart may stand at the head of the page, away from its table.
  details = Array.prototype.find.call(
      document.querySelectorAll('details'), e => e.querySelector('summary').textContent.includes('Pareto front'));
  const seen = selector =>
      Array.prototype.filter.call(details.querySelectorAll(selector), e => getComputedStyle(e).display !== 'none');
  const chart = window.noonmarkPage.kit.drawn.filter(one => one.figure === figure)[0];
  function front() {
    const bodies = seen('tbody'), summary = seen('summary span')[0] || details.querySelector('summary');
    return {
      bodies: bodies.length,
      rows: Array.from(bodies[0].rows, row => [row.cells[0].querySelector('a').textContent, row.cells[2].textContent]),
      summary: summary.textContent,
      drawn: chart.view.data('front')
                 .filter(row => row.entry)
                 .map(row => window.noonmarkPage.bias === 'set' ? row.entry.name : row.entry.name_at_bias),
      lines: figure.querySelectorAll('.technique-lines path').length,
      names: Array.from(figure.querySelectorAll('.curve-names text'), e => e.textContent),
      legend: figure.querySelector('.legend').textContent,
      takeovers: figure.querySelector('.takeovers').textContent
    };
  }
  const saw = {errors};
  for (const mode of ['recommended', 'set']) {
    window.noonmarkPage.setBias(mode);
    await later();
    saw[mode] = front();
  }
  leave(saw);
})();
