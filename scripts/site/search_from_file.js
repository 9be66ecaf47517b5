// The search of a site that is opened as a file, without a server. A browser starts no worker from a file, and reads no
// JSON from one. So this stands in for the worker of mkdocs' search (search/worker.js) and speaks its messages, with the
// index as a script (search/search_index.js, which scripts/site/hooks.py writes).
if (window.location.protocol === 'file:') {
  const load = (path) => new Promise((done, failed) => {
    const script = document.createElement('script');
    script.src = base_url + '/' + path;
    script.onload = done;
    script.onerror = failed;
    document.head.appendChild(script);
  });
  window.Worker = class {
    async postMessage(message) {
      if (message.init) {
        await load('search/lunr.js');
        await load('search/search_index.js');
        const { config, docs } = window.search_index;
        this.docs = new Map(docs.map((doc) => [doc.location, doc]));
        this.index = lunr(function () {
          this.field('title');
          this.field('text');
          this.ref('location');
          docs.forEach((doc) => this.add(doc));
        });
        this.onmessage({ data: { config } });
        this.onmessage({ data: { allowSearch: true } });
      } else if (message.query) {
        const results = this.index.search(message.query).map(({ ref }) => this.docs.get(ref));
        this.onmessage({ data: { results: results.map((doc) => ({ ...doc, summary: doc.text.substring(0, 200) })) } });
      }
    }
  };
}
