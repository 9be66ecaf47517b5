// Runs in the report's page after its own scripts (tests/compare/report/page_test.cpp). It reads the curves and the Pareto
// front at both biases of the page, as the chart draws them and as table and words say, and writes them to the element `probe`.
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
  var chart = window.noonmarkPage.kit.drawn.filter(function(one) {
    return one.figure === figure;
  })[0];
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
      drawn: chart.view.data('front')
                 .filter(function(row) {
                   return row.entry;
                 })
                 .map(function(row) {
                   return window.noonmarkPage.bias === 'set' ? row.entry.name : row.entry.name_at_bias;
                 }),
      lines: figure.querySelectorAll('.technique-lines path').length,
      names: Array.prototype.map.call(
          figure.querySelectorAll('.curve-names text'),
          function(e) {
            return e.textContent;
          }),
      legend: figure.querySelector('.legend').textContent,
      takeovers: figure.querySelector('.takeovers').textContent
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
