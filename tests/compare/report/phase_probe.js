// Runs in a page with a phase diagram after its own scripts (tests/compare/report/page_test.cpp). It points at the first of
// the sweep's points, if there are any, and clicks it; then the same at the cell of the coarsest texel and the least bias.
// It writes its observations to the element `probe`.
(async () => {
  'use strict';
  const saw = {errors};
  if (window.noonmarkPage.setBias) window.noonmarkPage.setBias('set');
  await later();
  const figure = document.getElementById('chart-phase'), cells = all('.mark-rect.role-mark path', figure);
  saw.cells = cells.length;
  saw.lines = all('.mark-line path', figure).length;
  saw.hatch = all('.mark-rule.role-mark line', figure).length;
  saw.texts = all('.mark-text.role-mark text', figure).map(t => t.textContent);
  // What the tip says over an element, which is then clicked.
  async function use(element) {
    const box = element.getBoundingClientRect();
    function send(kind) {
      element.dispatchEvent(new MouseEvent(
          kind,
          {bubbles: true, cancelable: true, clientX: box.left + box.width / 2, clientY: box.top + box.height / 2}));
    }
    send('mousemove');
    const tip = document.getElementById('tip').textContent;
    send('click');
    await later();
    return tip;
  }
  const rings = all('.mark-symbol.role-mark path', figure);
  saw.first_figure = document.querySelector('figure').id;
  if (rings.length) {
    saw.points = {rings: rings.length / 2, tip: await use(rings[rings.length / 2])};  // each ring has a rim below it
    saw.points.links = all('.command a', figure).map(a => a.getAttribute('href'));
    saw.points.selected = all('tr.selected').map(row => +row.dataset.point);
    saw.points.rows = all('#phase details:not([open]) tbody').filter(body => body.querySelector('a'))[0].rows.length;
  }
  saw.tip = await use(cells[0]);
  const code = figure.querySelector('.command code');
  saw.command = code ? code.textContent : '';
  // By keyboard: the first arrow takes a cell, the next ones move, Enter asks for its command.
  const plot = figure.querySelector('.plot');
  function key(name) {
    plot.dispatchEvent(new KeyboardEvent('keydown', {key: name, bubbles: true, cancelable: true}));
    return figure.querySelector('.spoken').textContent;
  }
  saw.keys = {stop: plot.tabIndex, first: key('ArrowRight')};
  for (let i = 0; i < 20; ++i) key('ArrowLeft'), key('ArrowUp');
  saw.keys.corner = key('ArrowLeft');
  saw.keys.right = key('ArrowRight');
  saw.keys.frames = all('.cursor', plot).length;
  key('Enter');
  saw.keys.command = (figure.querySelector('.command code') || {}).textContent;
  saw.rows = all('#phase table.numbers tbody tr').length;
  saw.title = document.querySelector('h1').textContent;

  leave(saw);
})();
