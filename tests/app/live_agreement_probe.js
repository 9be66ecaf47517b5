// The metrics of the states in liveStates, as tests/app/live_page_test.cpp asks for them.
noonmarkLive.ready.then(() => {
  leave({
    says: document.getElementById('says').textContent,
    metrics: liveStates.map(state => noonmarkLive.measure(state)),
    errors: errors
  });
});
