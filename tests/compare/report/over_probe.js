// Runs in the page of a filtered map with a curve over another setting after its own scripts
// (tests/compare/report/page_test.cpp). It reads the chart over that setting and writes what it saw to the element `probe`.
(async function() {
  'use strict';
  var page = window.noonmarkPage, figure = document.getElementById('chart-over'), saw = {errors: errors};
  var chart = page.kit.drawn.filter(function(one) {
    return one.figure === figure;
  })[0];
  function chosen(id) {  // and drawn
    page.select(id);
    return new Promise(function(go) {
      setTimeout(go, 0);
    });
  }
  function texts(selector) {
    return Array.prototype.map.call(figure.querySelectorAll(selector), function(e) {
      return e.textContent;
    });
  }
  // The dashes of the lines as drawn, and of the legend's, by their colour and thickness.
  function look(line) {
    return [
      line.getAttribute('stroke'), line.getAttribute('stroke-width'),
      (line.getAttribute('stroke-dasharray') || '').replace(/,/g, ' ')
    ].join('; ');
  }
  function observe() {
    return {
      title: texts('.role-axis-title text'),
      marks: texts('.mark-text text').filter(function(t) {
        return t === 'least error' || t === 'as set';
      }),
      values: chart.view.scale('x').domain(),
      series: chart.view.data('rows').map(function(row) {
        return row.series;
      }).filter(function(s, i, list) {
        return list.indexOf(s) === i;
      }),
      least: chart.view.data('rows').filter(function(row) {
        return row.series === 'error';
      }).map(function(row) {
        return row.v;
      })
    };
  }
  await chosen(0);
  saw.first = observe();
  saw.points = texts('.controls option');
  saw.drawn = Array.prototype.map.call(figure.querySelectorAll('.mark-line path'), look);
  saw.legend = Array.prototype
                   .filter.call(figure.querySelectorAll('.legend > span'), function(e) {
                     return e.querySelector('line');
                   })
                   .map(function(e) {
                     return [e.textContent, look(e.querySelector('line'))];
                   });
  await chosen(1);
  saw.second = observe();
  await chosen(2);  // which has no such curve: the chart stays
  saw.third = observe();
  leave(saw);
})();
