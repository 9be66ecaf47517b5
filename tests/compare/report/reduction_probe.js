// Runs in the page of a filtered map after its own scripts (tests/compare/report/page_test.cpp). It reads the chart over the
// reduction, the switch of the page and the card of a point, and writes them to the element `probe`.
(async function() {
  'use strict';
  var page = window.noonmarkPage, figure = document.getElementById('chart-reduction'), saw = {errors: errors};
  var chart = page.kit.drawn.filter(function(one) {
    return one.figure === figure;
  })[0];
  function chosen(id) {  // and drawn
    page.select(id);
    return new Promise(function(go) {
      setTimeout(go, 0);
    });
  }
  function facts() {
    return figure.querySelector('.facts').textContent;
  }
  function windows() {
    return figure.querySelectorAll('.mark-rect.role-mark path').length;
  }
  saw.choice = document.querySelector('.bias-choice').firstChild.textContent;
  await chosen(0);
  saw.first = facts();
  saw.windows = [windows()];
  await chosen(1);
  saw.second = facts();
  saw.windows.push(windows());
  saw.bounds = figure.querySelectorAll('.mark-rule.bound line').length;
  saw.bound = Array.prototype
                  .map.call(
                      figure.querySelectorAll('.mark-text text'),
                      function(e) {
                        return e.textContent;
                      })
                  .filter(function(text) {
                    return text.indexOf('bound') === 0;
                  })
                  .join('; ');
  saw.zeros = chart.view.data('rows')
                  .filter(function(row) {
                    return row.series === 'leak' && row.r >= 0.3;
                  })
                  .length;
  saw.dashed = Array.prototype
                   .filter.call(
                       figure.querySelectorAll('.legend > span'),
                       function(e) {
                         return e.querySelector('svg');
                       })
                   .map(function(e) {
                     return e.textContent;
                   });
  page.open(1, 'recommended');
  var card = document.querySelector('dialog');
  saw.verdict = card.textContent;
  saw.command = card.querySelector('.command').textContent;
  leave(saw);
})();
