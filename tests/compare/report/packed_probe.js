// Runs in a page whose data block is packed (tests/compare/report/page_test.cpp), and writes to the element `probe` what
// the page unpacked and drew.
(async () => {
  'use strict';
  const page = window.noonmarkPage, saw = {errors: errors, packed: document.querySelector('[data-packed]') !== null};
  saw.said = document.querySelector('main p').textContent;
  saw.fallback_rows = document.querySelectorAll('main tr[id]').length;
  if (page) {
    saw.points = page.data.points;
    saw.cells = document.querySelectorAll('#chart-function .wide .cell').length;
    saw.rows = document.querySelectorAll('.points-place tbody tr').length;
  }
  leave(saw);
})();
