// The search: the sections that hold the words, the best one first. The index is a script (scripts/site/hooks.py), because
// a page that is opened as a file may not read JSON.
'use strict';
const sections = new Map(search_index.docs.map((section) => [section.location, section]));
const index = lunr(function () {
  this.field('title', { boost: 10 });
  this.field('text');
  this.ref('location');
  search_index.docs.forEach((section) => this.add(section));
});

function element(name, text) {
  const made = document.createElement(name);
  made.textContent = text;
  return made;
}

// What of the section is shown: where a word stands in it first.
function excerpt(text, words) {
  const at = Math.min(...words.map((word) => text.toLowerCase().indexOf(word)).filter((place) => place >= 0), text.length);
  const begin = at < text.length ? text.lastIndexOf(' ', Math.max(0, at - 60)) + 1 : 0;
  return (begin ? '… ' : '') + text.slice(begin, begin + 240) + (begin + 240 < text.length ? ' …' : '');
}

function show(query) {
  const words = query.toLowerCase().split(/[^\w.]+/).filter(Boolean);
  const results = index.query((q) => words.forEach((word) => {
    q.term(lunr.tokenizer(word), {});
    q.term(word, { wildcard: lunr.Query.wildcard.TRAILING, usePipeline: false });
  })).slice(0, 40);
  const found = document.getElementById('found');
  found.replaceChildren(...results.map(({ ref }) => {
    const section = sections.get(ref), article = document.createElement('article'), heading = document.createElement('h2');
    const page = sections.get(ref.split('#')[0]);
    const link = element('a', page === section ? section.title : `${page.title}: ${section.title}`);
    link.href = ref;
    heading.append(link);
    article.append(heading, element('p', excerpt(section.text, words)));
    return article;
  }));
  if (query && !results.length) found.append(element('p', `Nothing holds “${query}”.`));
}

const box = document.getElementById('query');
box.value = new URLSearchParams(location.search).get('q') ?? '';
box.addEventListener('input', () => show(box.value));
show(box.value);
