// The weight grows evenly, as in Babylon.js, Bevy and three.js's CSM.
real linear_blend(real way) { return way; }
