extends SceneTree

# godot3-server --path FOLDER -s main.gd: prints the digest of a model that the C library tore.
func _init():
	var native = GDNative.new()
	native.library = load("res://sample.gdnlib")
	if native.initialize():
		print(native.call_native("standard_varcall", "sunder_tear_sheet", []))
		native.terminate()
	quit()
