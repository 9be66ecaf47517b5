extends Spatial
# a directional sun (or what SHADOW_LIGHT says) on a ground, a box, a sphere and a pole; all made here
func material(c):
	var m = SpatialMaterial.new()
	m.albedo_color = c
	m.roughness = 0.9
	m.metallic_specular = 0.0
	return m
func put(mesh, at, c):
	var i = MeshInstance.new()
	i.mesh = mesh
	i.translation = at
	i.material_override = material(c)
	add_child(i)
	return i
func _ready():
	var kind = OS.get_environment("SHADOW_LIGHT")
	var bias = OS.get_environment("SHADOW_BIAS")
	var g = PlaneMesh.new()
	g.size = Vector2(20, 20)
	put(g, Vector3(0, 0, 0), Color(0.8, 0.8, 0.8))
	var c = CubeMesh.new()
	c.size = Vector3(1, 1, 1)
	put(c, Vector3(-1, 0.7, 0), Color(0.8, 0.3, 0.3)).rotation_degrees = Vector3(0, 20, 0)
	var s = SphereMesh.new()
	s.radius = 0.6
	s.height = 1.2
	put(s, Vector3(1.5, 1.1, -0.8), Color(0.3, 0.8, 0.3))
	var y = CylinderMesh.new()
	y.top_radius = 0.15
	y.bottom_radius = 0.15
	y.height = 1.6
	put(y, Vector3(1.0, 0.8, 1.5), Color(0.3, 0.3, 0.8))
	if OS.get_environment("SHADOW_OFF") != "":
		put(c, Vector3(-4.6, 6.2, 3.6), Color(1, 1, 1))   # a box that the camera does not see, whose shadow it sees
	var cam = Camera.new()
	cam.fov = 45
	cam.near = 0.1
	cam.far = 60
	cam.look_at_from_position(Vector3(3, 3.5, 6), Vector3(0, 0.4, 0), Vector3(0, 1, 0))
	add_child(cam)
	cam.current = true
	var l
	if kind == "point":
		l = OmniLight.new()
		l.omni_range = 12
		l.translation = Vector3(-1.5, 3.5, 1.5)
	elif kind == "spot":
		l = SpotLight.new()
		l.spot_range = 14
		l.spot_angle = 35
		l.look_at_from_position(Vector3(-3, 5, 3), Vector3(0, 0, 0), Vector3(0, 1, 0))
	else:
		l = DirectionalLight.new()
		l.look_at_from_position(Vector3(-3, 5, 2), Vector3(0, 0, 0), Vector3(0, 1, 0))
		l.directional_shadow_mode = 0
		if kind == "cascades":
			l.directional_shadow_mode = 2
		l.directional_shadow_max_distance = 30
	l.shadow_enabled = true
	if bias != "":
		l.shadow_bias = float(bias)
	add_child(l)
	if kind == "two":
		var k = SpotLight.new()
		k.spot_range = 14
		k.spot_angle = 35
		k.shadow_enabled = true
		k.look_at_from_position(Vector3(4, 5, 3), Vector3(0, 0, 0), Vector3(0, 1, 0))
		add_child(k)
		set_meta("k", k)
	var e = Environment.new()
	e.background_mode = Environment.BG_COLOR
	e.background_color = Color(0.1, 0.15, 0.2)
	e.ambient_light_color = Color(1, 1, 1)
	e.ambient_light_energy = 0.2
	var w = WorldEnvironment.new()
	w.environment = e
	add_child(w)
	set_meta("l", l)
	set_meta("p", l.translation)
var t = 0
func _process(_d):
	t += 1
	if has_meta("k"):
		get_meta("k").translation = Vector3(4 + 1e-5 * (t % 2), 5, 3)
	get_meta("l").translation = get_meta("p") + Vector3(1e-5 * (t % 2), 0, 0)   # so that the engine draws its map anew in each frame
