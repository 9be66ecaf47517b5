// Stands in the page of a test before its own scripts: collects their errors, and gives the probes what all of them need.
const errors = [];
addEventListener('error', e => errors.push(e.message));
addEventListener('unhandledrejection', e => errors.push(String(e.reason)));
addEventListener('securitypolicyviolation', e => errors.push(e.violatedDirective));
for (const kind of ['error', 'warn']) console[kind] = what => errors.push(String(what));

const all = (selector, root = document) => Array.from(root.querySelectorAll(selector));
// Vega draws only after the script that called it has ended.
const later = () => new Promise(go => setTimeout(go, 0));

// A section that is unfolded draws its charts then.
async function unfold() {
  all('details.fold').forEach(d => d.open = true);
  await later();
  await later();
}

// Leaves what a probe saw in the page, where the test reads it.
function leave(saw) {
  const probe = document.createElement('pre');
  probe.id = 'probe';
  probe.textContent = JSON.stringify(saw).replace(/[<>&]/g, c => '\\u00' + c.charCodeAt(0).toString(16));
  document.body.append(probe);
  if (parent !== window) parent.postMessage(probe.textContent, '*');
}
