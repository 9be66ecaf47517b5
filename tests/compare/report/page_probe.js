// Runs in the report's page after its own scripts (tests/compare/report/page_test.cpp). It uses the page as a reader
// does, with clicks and keys, and writes its observations to the element `probe`. browser.h gives the
// list `errors` and leave().
(async () => {
  'use strict';
  const saw = {errors};
  async function click(element) {
    element.dispatchEvent(new MouseEvent('click', {bubbles: true, cancelable: true, view: window}));
    await later();
  }
  function press(key) {
    document.dispatchEvent(new KeyboardEvent('keydown', {key: key, bubbles: true, cancelable: true}));
  }
  const button = (figure, text) => all('button', figure).filter(b => b.textContent === text)[0];
  function marks(figure) {
    const count = {};
    ['line', 'area', 'symbol', 'rule', 'rect'].forEach(
        kind => count[kind] = all('.mark-' + kind + ' path, .mark-' + kind + ' line', figure).length);
    count.zero = all('.mark-text.role-mark text', figure).filter(t => t.textContent === '0').length;
    return count;
  }
  const selected = () => all('tr.selected').map(row => +row.dataset.point);

  // The numbers below are those of the bias as set.
  saw.bias_choice = [window.noonmarkPage.bias];
  await click(button(document.querySelector('.bias-choice'), 'Recommended'));
  saw.bias_choice.push(window.noonmarkPage.bias);
  function table_error_of_5() {
    const column = all('table.sortable th[scope=col]').findIndex(h => h.textContent.indexOf('Error') === 0);
    return +document.getElementById('p5').cells[column].dataset.v;
  }
  saw.at_recommended = {
    error: table_error_of_5(),
    words: getComputedStyle(document.querySelector('.as-set')).display
  };
  await click(button(document.querySelector('.bias-choice'), 'As set'));
  saw.bias_choice.push(window.noonmarkPage.bias);
  saw.as_set = {
    error: table_error_of_5(),
    words: getComputedStyle(document.querySelector('.as-set')).display
  };
  // What WCAG asks and can be read from the page: each control has a name, headings go down by one level, images have texts.
  saw.unnamed =
      all('button, select, input, [role=region], [role=img], [role=group]')
          .filter(e => {
            let name = (e.getAttribute('aria-label') || '') + e.textContent + (e.title || '');
            if (/^(INPUT|SELECT)$/.test(e.tagName)) {
              name = e.getAttribute('aria-label') || '';
              Array.from(e.labels || [])
                  .forEach(l => name += Array.from(l.childNodes).filter(n => n !== e).map(n => n.textContent).join(''));
            }
            return !name.trim();
          })
          .map(e => e.outerHTML.slice(0, 120));
  saw.images_without_text = all('img:not([alt])').length;
  let level = 1;
  saw.headings = all('h1, h2, h3, h4')
                     .filter(h => {
                       const now = +h.tagName[1], skips = now > level + 1;
                       level = now;
                       return skips;
                     })
                     .map(h => h.textContent);
  saw.data_of_5 = window.noonmarkPage.data.points[5];

  saw.charts = {};
  all('figure[id^="chart-"]').forEach(figure => saw.charts[figure.id] = marks(figure));

  // The first figure: a pointer reads numbers, the list chooses a grid.
  const figure = document.getElementById('chart-function'), tip = document.getElementById('tip');
  const grid = () => all('.function-grid', figure).filter(g => !g.hidden);
  const cell = i => all('.wide .cell', grid()[0])[i];
  function point_at(element, share, type) {
    const box = element.getBoundingClientRect();
    element.dispatchEvent(new MouseEvent(
        type, {bubbles: true, clientX: box.left + share * box.width, clientY: box.top + box.height / 2}));
  }
  const filters = figure.querySelector('.controls select');
  function choose(value) {
    filters.value = value;
    filters.dispatchEvent(new Event('change'));
  }
  saw.figure = {
    first: document.querySelector('figure.chart').id,
    grids: all('.function-grid', figure).length,
    shown: grid().map(g => g.dataset.chosen),
    cells: all('.wide .cell', grid()[0]).length
  };
  point_at(cell(5), 0.5, 'mousemove');
  saw.figure.tip = tip.textContent;
  saw.figure.tip_rows = all('tr', tip).map(row => Array.from(row.cells).map(c => c.textContent));
  saw.figure.cursor = all('.wide .cursor', grid()[0])[0].getAttribute('visibility');
  figure.querySelector('.plot').dispatchEvent(new MouseEvent('mouseleave'));
  saw.figure.left = [tip.hidden, all('.wide .cursor', grid()[0])[0].getAttribute('visibility')];
  choose('box');
  saw.figure.other = grid().map(g => g.dataset.chosen);
  choose('none');

  // The table: a click on a heading sorts, and a second click reverses the order. A click on a row selects its point in
  // all charts and pictures.
  const table = document.querySelector('table.sortable'), heads = all('th', table.tHead);
  const column = name => heads.findIndex(h => h.textContent.indexOf(name) === 0);
  const order = i => all('tr', table.tBodies[0]).map(row => row.cells[i].dataset.v);
  const error = column('Error'), filter = column('filter');
  saw.table = {error: []};
  for (let i = 0; i < 2; ++i) {
    await click(heads[error].querySelector('button'));
    saw.table.error.push(order(error));
  }
  saw.table.sorted = heads[error].getAttribute('aria-sort');
  heads[filter].querySelector('button').focus();
  saw.table.focus = document.activeElement === heads[filter].querySelector('button');
  await click(document.activeElement);  // as Enter does on a button
  saw.table.filter = order(filter);
  await click(document.getElementById('p5').cells[1]);
  saw.selected_by_row = selected();
  saw.cells_of_5 = all('.wide .cell.selected').map(c => c.dataset.points);
  saw.grid_of_5 = grid().map(g => g.dataset.chosen);
  saw.clicked = cell(3).dataset.points.split(':')[0];
  point_at(cell(3), 0.1, 'click');
  await later();
  saw.selected_by_click = selected();

  // The card of a point: opened by a row, with its numbers, its command, and its pictures.
  const card = document.getElementById('card');
  const card_now = () => ({
    open: card.open,
    title: card.querySelector('h2').textContent,
    command: card.querySelector('.command code').textContent,
    rows: card.querySelectorAll('tbody tr').length,
    pictures: card.querySelectorAll('.wide img').length,
    left: (card.querySelector('.wide img') || {}).alt,
    divide: card.querySelectorAll('.wide img').length ? card.querySelectorAll('.wide img')[1].style.clipPath : '',
    width: (card.querySelector('.wide') || {style: {}}).style.width,
    cuts: card.querySelectorAll('.cuts canvas').length
  });
  saw.card = {by_click: card.open};
  await click(card.querySelectorAll('.card-head button')[2]);
  saw.card.closed = !card.open;
  await click(document.querySelector('a[href="#p18"]'));
  // The browser's virtual time waits for a load, but not for decode().
  await Promise.all(
      all('.wide img', card).map(i => i.complete ? null : new Promise(go => i.addEventListener('load', go))));
  await later();
  saw.card.with_pictures = card_now();
  const failure = () => ({
    words: card.querySelector('.card-inner > p').textContent,
    pixel: card.querySelector('.card-pictures [role=status]').textContent,
    section: (card.querySelector('.cuts .section img') || {}).alt,
    chosen: all('.card-pictures select', card).map(list => list.value).pop(),
    bias: card.querySelector('.card-inner .segments [aria-pressed=true]').textContent
  });
  saw.card.failure = failure();
  card.dispatchEvent(new KeyboardEvent('keydown', {key: '+', bubbles: true}));
  const divide = card.querySelector('input[type=range]');
  divide.value = 20;
  divide.dispatchEvent(new Event('input'));
  saw.card.zoomed = card_now();
  page_bias('recommended');
  saw.card.recommended = card_now();
  card.close();
  await click(all('tr[data-point="18"] td', table)[1]);
  saw.card.failure_by_row = failure();
  card.close();
  window.noonmarkPage.open(18, 'recommended');
  saw.card.asked_recommended = failure().bias;
  page_bias('set');
  function page_bias(mode) {
    window.noonmarkPage.setBias(mode);
  }
  await click(card.querySelectorAll('.card-head button')[1]);
  saw.card.next = card_now();
  card.close();

  // Search: all words must be there.
  const search = document.querySelector('.points-place input[type=search]');
  search.value = 'box 2048';
  search.dispatchEvent(new Event('input'));
  saw.found = all('tr', table.tBodies[0]).map(row => +row.dataset.point);
  search.value = '';
  search.dispatchEvent(new Event('input'));

  // Pictures: keys change them only while they are in view and no list has the focus.
  const set = document.querySelector('.pictures');
  function shown() {
    const visible = all('.pictures').filter(s => !s.hidden);
    return visible.length + ' ' + visible[0].dataset.point + ' ' +
        all('figure.shown', visible[0]).map(f => f.dataset.name);
  }
  const picker = document.querySelector('.picture-picker select');
  function show_point(id) {
    picker.value = id;
    picker.dispatchEvent(new Event('change'));
  }
  show_point(set.dataset.point);
  window.scrollTo({top: 0, behavior: 'instant'});
  press('ArrowRight');
  saw.flips = [shown()];  // not in view: nothing happens
  set.scrollIntoView({behavior: 'instant'});
  ['ArrowRight', 'ArrowRight', 'ArrowRight', 'ArrowLeft', '2', '9'].forEach(key => {
    press(key);
    saw.flips.push(shown());
  });
  picker.focus();
  press('ArrowRight');
  saw.flips.push(shown());
  picker.blur();
  show_point(all('.pictures')[1].dataset.point);
  saw.flips.push(shown());

  // The charts by keyboard.
  async function keys_in(id, names) {
    const figure = document.getElementById(id), plot = figure.querySelector('.plot'), said = [];
    for (const name of names) {
      plot.dispatchEvent(new KeyboardEvent('keydown', {key: name, bubbles: true, cancelable: true}));
      await later();
      said.push(figure.querySelector('.spoken').textContent);
    }
    return {stop: plot.tabIndex, said: said, tip: document.getElementById('tip').hidden};
  }
  if (card.open) await click(card.querySelectorAll('.card-head button')[2]);
  saw.keys = await keys_in('chart-function', ['ArrowRight', 'ArrowRight', 'Home', 'End', 'Escape']);
  await keys_in('chart-function', ['Home', 'Enter']);
  saw.keys.card = card.open && card.querySelector('h2').textContent;

  leave(saw);
})();
