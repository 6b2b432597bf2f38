"""A picture by Cycles, in Blender: balls of glass, metal and a half transparent material, instances, an area light.

usage: blender -b --factory-startup -P cycles_scene.py -- FILE.bmp
"""
import sys
import time

import bpy


def material(name, **inputs):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    for key, value in inputs.items():
        made.node_tree.nodes['Principled BSDF'].inputs[key].default_value = value
    return made


bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.engine, scene.cycles.device = 'CYCLES', 'CPU'
scene.cycles.samples, scene.cycles.seed, scene.cycles.use_adaptive_sampling = 32, 81, False
scene.cycles.use_denoising = False
scene.render.threads_mode, scene.render.threads = 'FIXED', 1
scene.render.resolution_x, scene.render.resolution_y = 200, 150
scene.render.filepath, scene.render.image_settings.file_format = sys.argv[-1], 'BMP'
bpy.ops.mesh.primitive_plane_add(size=30)
for i, made in enumerate((material('glass', Transmission=1.0, Roughness=0.0), material('skin', Subsurface=0.4),
                          material('metal', Metallic=1.0, Roughness=0.2), material('veil', Alpha=0.5))):
    bpy.ops.mesh.primitive_monkey_add(location=(2.4 * i - 3.6, 0, 1), rotation=(0, 0, 0.3 * i))
    bpy.context.object.modifiers.new('smooth', 'SUBSURF').render_levels = 2
    bpy.context.object.data.materials.append(made)
first = bpy.context.object
for i in range(5):
    copy = first.copy()
    copy.location, copy.scale = (2 * i - 4, 3, 1), (0.8, 0.8, 0.8)
    bpy.context.collection.objects.link(copy)
bpy.ops.object.light_add(type='AREA', location=(3, -5, 7), rotation=(0.6, 0.3, 0))
bpy.context.object.data.energy, bpy.context.object.data.size = 900, 3
bpy.ops.object.camera_add(location=(0, -10, 4), rotation=(1.25, 0, 0))
scene.camera = bpy.context.object
begin = time.process_time()
bpy.ops.render.render(write_still=True)
print('seconds', time.process_time() - begin)
print('library', next(line.split()[-1] for line in open('/proc/self/maps') if 'libembree3.so' in line))
