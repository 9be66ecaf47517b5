// Runs in the report's page after its own scripts (tests/compare/report/page_test.cpp). It reads the Pareto front at both
// biases of the page, as the chart names it and as the table shows it, and writes both to the element `probe`.
(async function() {
  'use strict';
  var figure = document.getElementById('chart-cost'), details;
  // The chart may stand at the head of the page, away from its table.
  details = Array.prototype.find.call(document.querySelectorAll('details'), function(e) {
    return e.querySelector('summary').textContent.indexOf('Pareto front') >= 0;
  });
  function seen(selector) {
    return Array.prototype.filter.call(details.querySelectorAll(selector), function(e) {
      return getComputedStyle(e).display !== 'none';
    });
  }
  function front() {
    var bodies = seen('tbody'), summary = seen('summary span')[0] || details.querySelector('summary');
    return {
      bodies: bodies.length,
      rows: Array.prototype.map.call(
          bodies[0].rows,
          function(row) {
            return [row.cells[0].querySelector('a').textContent, row.cells[2].textContent];
          }),
      summary: summary.textContent,
      note: figure.querySelector('p.small').textContent
    };
  }
  var saw = {errors: errors};
  for (var mode of ['recommended', 'set']) {
    window.noonmarkPage.setBias(mode);
    await new Promise(function(go) {
      setTimeout(go, 0);
    });
    saw[mode] = front();
  }
  leave(saw);
})();
