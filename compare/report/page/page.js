// The page around the charts: pictures to switch between, and the first drawing.
(function() {
'use strict';
var page = window.noonmarkPage, kit = page.kit, make = kit.make;

// ---- pictures
var sets = Array.prototype.slice.call(document.querySelectorAll('.pictures')), current = null;
sets.forEach(function(set) {
  var figures = Array.prototype.slice.call(set.querySelectorAll('figure')), flip = make('div', {class: 'flip'});
  function show(i) {
    i = (i + figures.length) % figures.length;
    set.shownIndex = i;
    figures.forEach(function(f, j) {
      f.classList.toggle('shown', i === j);
      flip.children[j].setAttribute('aria-pressed', String(i === j));
    });
    enlarge();
  }
  figures.forEach(function(f, j) {
    flip.append(make(
        'button', {
          type: 'button',
          on: {
            click: function() {
              show(j);
            }
          }
        },
        (j < 9 ? j + 1 + ' ' : '') + f.dataset.name));
  });
  set.querySelector('.stage').before(flip);
  set.show = show;
  set.count = figures.length;
  set.dataset.ready = '';
  show(0);
});
function choose(set) {
  current = set;
  sets.forEach(function(s) {
    s.hidden = s !== set;
  });
}
// A picture with fewer pixels than its place is enlarged with square pixels, because each pixel was judged by itself.
function enlarge() {
  document.querySelectorAll('.stage img').forEach(function(i) {
    i.classList.toggle('enlarged', i.naturalWidth > 0 && i.naturalWidth < i.clientWidth);
  });
}
if (sets.length) {
  choose(sets[0]);
  if (sets.length > 1)
    document.querySelector('.picture-picker')
        .append(kit.picker(
            'Point', sets.map(function(s) {
              return [s.dataset.point, s.querySelector('h3').textContent];
            }),
            sets[0].dataset.point, function(id) {
              var kept = current.shownIndex;
              choose(sets.filter(function(s) {
                return s.dataset.point === id;
              })[0]);
              current.show(Math.min(kept, current.count - 1));
            }));
}
// Keys work while the pictures are in view and no element that takes keys has the focus.
document.addEventListener('keydown', function(event) {
  if (!current || event.ctrlKey || event.metaKey || event.altKey || document.querySelector('dialog[open]') ||
      /^(SELECT|INPUT|TEXTAREA)$/.test(document.activeElement.tagName))
    return;
  var box = current.getBoundingClientRect();
  if (box.bottom < 60 || box.top > innerHeight - 60) return;
  var i = current.shownIndex, digit = event.key >= '1' && event.key <= '9' ? +event.key - 1 : -1;
  if (event.key === 'ArrowRight')
    current.show(i + 1);
  else if (event.key === 'ArrowLeft')
    current.show(i - 1);
  else if (digit >= 0 && digit < current.count)
    current.show(digit);
  else
    return;
  event.preventDefault();
});

page.onSelect.push(function(id) {
  var set = sets.filter(function(s) {
    return +s.dataset.point === id;
  })[0];
  if (set && set !== current) {
    choose(set);
    var s = document.querySelector('.picture-picker select');
    if (s) s.value = String(id);
  }
});

// What scrolls can be scrolled with the keyboard, and has the name of the heading or the summary before it.
function scrollable() {
  document.querySelectorAll('.scroll, .places.many .rows').forEach(function(box) {
    if (box.tabIndex === 0 || (box.scrollWidth <= box.clientWidth && box.scrollHeight <= box.clientHeight)) return;
    var folded = box.closest('details'), above = (box.closest('section') || document).querySelector('h1, h2');
    box.tabIndex = 0;
    box.setAttribute('role', 'region');
    box.setAttribute(
        'aria-label',
        'Table: ' + (folded ? folded.querySelector('summary') : above).textContent + ' ' +
            (1 + Array.prototype.indexOf.call(document.querySelectorAll('.scroll, .rows'), box)));
  });
}

// On paper nothing is folded but what is left out there (style.css), and tables of more numbers than a chart beside them has.
var unfolded = [];
addEventListener('beforeprint', function() {
  unfolded = Array.prototype.slice.call(document.querySelectorAll('details:not([open]):not(.glossary):not(.more):not(.fold)'));
  unfolded.forEach(function(d) {
    d.open = true;
  });
});
addEventListener('afterprint', function() {
  unfolded.forEach(function(d) {
    d.open = false;
  });
});

// ---- what is folded unfolds for a link to what it holds
function reveal(address) {
  var aim = address.length > 1 && document.getElementById(address.slice(1)), fold = aim && aim.closest('details.fold');
  if (!fold || fold.open) return;
  fold.open = true;
  aim.scrollIntoView();
}
document.addEventListener('click', function(event) {
  var link = event.target.closest('a[href^="#"]');
  if (link) reveal(link.getAttribute('href'));
});
document.querySelectorAll('details.fold').forEach(function(fold) {
  fold.addEventListener('toggle', drawAll);
});
reveal(location.hash);

// ---- first drawing, and again when the width changes. What is folded is drawn once it is unfolded.
function drawAll() {
  kit.drawn.forEach(function(c) {
    if (c.plot.clientWidth) c.draw();
  });
  enlarge();
  scrollable();
}
page.redraw = drawAll;
drawAll();
addEventListener('load', enlarge);
if (page.openByAddress) page.openByAddress();
var width = innerWidth, timer = 0;
addEventListener('resize', function() {
  if (innerWidth === width) return;
  width = innerWidth;
  clearTimeout(timer);
  timer = setTimeout(drawAll, 150);
});
})();
