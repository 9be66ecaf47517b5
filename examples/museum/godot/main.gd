# A ground, a box, a ball and a pole under one light of Godot 3. The environment chooses: SHADOW_LIGHT=sun, cascades, spot,
# point or two; SHADOW_BIAS=NUMBER; SHADOW_SIZE=TEXELS of the atlas (spot and point); SHADOW_REVERSE=1 draws back faces into
# the map; SHADOW_CAST=0 leaves the ball out of it.
extends Spatial

var lights = []
var frame = 0

func put(mesh, at, color):
	var one = MeshInstance.new()
	var material = SpatialMaterial.new()
	material.albedo_color = color
	material.roughness = 0.9
	material.metallic_specular = 0.0
	one.mesh = mesh
	one.translation = at
	one.material_override = material
	add_child(one)
	return one

func shine(light, from):
	light.shadow_enabled = true
	if OS.has_environment("SHADOW_BIAS"):
		light.shadow_bias = float(OS.get_environment("SHADOW_BIAS"))
	light.shadow_reverse_cull_face = OS.has_environment("SHADOW_REVERSE")
	add_child(light)
	light.look_at_from_position(from, Vector3(0, 0, 0), Vector3(0, 1, 0))
	lights.append([light, from])

func spot(from):
	var light = SpotLight.new()
	light.spot_range = 14
	light.spot_angle = 35
	shine(light, from)

func _ready():
	if OS.has_environment("SHADOW_SIZE"):
		get_viewport().shadow_atlas_size = int(OS.get_environment("SHADOW_SIZE"))
	var ground = PlaneMesh.new()
	ground.size = Vector2(20, 20)
	put(ground, Vector3(0, 0, 0), Color(0.8, 0.8, 0.8))
	var box = CubeMesh.new()
	box.size = Vector3(1, 1, 1)
	put(box, Vector3(-1, 0.7, 0), Color(0.8, 0.3, 0.3)).rotation_degrees = Vector3(0, 20, 0)
	var ball = SphereMesh.new()
	ball.radius = 0.6
	ball.height = 1.2
	if OS.get_environment("SHADOW_CAST") == "0":
		put(ball, Vector3(1.5, 1.1, -0.8), Color(0.3, 0.8, 0.3)).cast_shadow = GeometryInstance.SHADOW_CASTING_SETTING_OFF
	else:
		put(ball, Vector3(1.5, 1.1, -0.8), Color(0.3, 0.8, 0.3))
	var pole = CylinderMesh.new()
	pole.top_radius = 0.15
	pole.bottom_radius = 0.15
	pole.height = 1.6
	put(pole, Vector3(1.0, 0.8, 1.5), Color(0.3, 0.3, 0.8))
	var camera = Camera.new()
	camera.fov = 45
	camera.near = 0.1
	camera.far = 60
	add_child(camera)
	camera.look_at_from_position(Vector3(3, 3.5, 6), Vector3(0, 0.4, 0), Vector3(0, 1, 0))
	camera.current = true
	var kind = OS.get_environment("SHADOW_LIGHT")
	if kind == "point":
		var light = OmniLight.new()
		light.omni_range = 12
		shine(light, Vector3(-1.5, 3.5, 1.5))
	elif kind == "spot":
		spot(Vector3(-3, 5, 3))
	else:
		var light = DirectionalLight.new()
		light.directional_shadow_mode = DirectionalLight.SHADOW_PARALLEL_4_SPLITS if kind == "cascades" else DirectionalLight.SHADOW_ORTHOGONAL
		light.directional_shadow_max_distance = 30
		shine(light, Vector3(-3, 5, 2))
	if kind == "two":
		spot(Vector3(4, 5, 3))
	var environment = Environment.new()
	environment.background_mode = Environment.BG_COLOR
	environment.background_color = Color(0.1, 0.15, 0.2)
	environment.ambient_light_color = Color(1, 1, 1)
	environment.ambient_light_energy = 0.2
	var world = WorldEnvironment.new()
	world.environment = environment
	add_child(world)

func _process(_delta):  # Godot draws a map again only when something moved
	frame = 1 - frame
	for one in lights:
		one[0].translation = one[1] + Vector3(1e-5 * frame, 0, 0)
