// The metrics of the states in liveStates, as tests/app/live_page_test.cpp asks for them.
noonmarkLive.ready.then(function() {
  leave({
    says: document.getElementById('says').textContent,
    drawn: getComputedStyle(document.getElementById('frame')).display !== 'none' && document.getElementById('frame').offsetParent !== null,
    metrics: liveStates.map(function(state) { return noonmarkLive.measure(state); }),
    errors: errors
  });
});
