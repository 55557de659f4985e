#!/usr/bin/env python3
"""Writes the low-level part of the C# binding from sunder_api.json.

    make_calls.py API FOLDER            NativeCalls.cs, Structs.cs, Enums.cs and Views.cs
    make_calls.py API FOLDER --layouts  Layouts.cs, which compares the structs with the offsets of the C compiler, for the tests

Structs are blittable: numbers of fixed width, pointers, and structs of these, so that calls need no marshalling and run
under IL2CPP. Those that a program fills in or reads are in the namespace Sunder; those that are arrays and texts of the
library, which the layer wraps, are in Sunder.Native.
"""
import json
import os
import pathlib
import re
import sys

NUMBERS = {'uint8_t': 'byte', 'uint32_t': 'uint', 'int32_t': 'int', 'uint64_t': 'ulong', 'float': 'float', 'double': 'double',
           'char': 'byte', 'void': 'void'}
# Fields that are arrays of fixed length; Vectors.cs has these.
VECTORS = {('float', 3): 'Vector3f', ('float', 4): 'Vector4f', ('double', 2): 'Vector2d', ('double', 3): 'Vector3d', ('double', 4): 'Vector4d',
           ('double', 9): 'Matrix3x3d', ('double', 12): 'Matrix3x4d', ('uint32_t', 3): 'Triangle'}
# Names that would be those of an engine's types, or verbs.
RENAMED = {'sunder_transform': 'BoneTransform', 'sunder_material': 'TissueMaterial', 'sunder_collider': 'TissueCollider',
           'sunder_blade': 'BladePosition', 'sunder_range': 'VertexRange', 'sunder_cut': 'PlaneCut', 'sunder_detach': 'Detachment',
           'sunder_contact': 'SurfaceContact'}
# Enums have no names in C. The name here, by the first constant, and what the constants begin with; for others see named_by_prefix().
ENUMS = {'SUNDER_OK': ('Status', 'SUNDER_'), 'SUNDER_FEATURE_THREADS': ('Features', 'SUNDER_FEATURE_'),
         'SUNDER_TARGET_TRANSLATION': ('ChannelTarget', 'SUNDER_TARGET_'), 'SUNDER_INTERPOLATE_LINEAR': ('Interpolation', 'SUNDER_INTERPOLATE_'),
         'SUNDER_NOTE_INFORMATION': ('NoteKind', 'SUNDER_NOTE_'), 'SUNDER_SKIN_LINEAR': ('Skinning', 'SUNDER_SKIN_'),
         'SUNDER_WEIGHTS_BARYCENTRIC': ('WeightPolicy', 'SUNDER_WEIGHTS_'), 'SUNDER_LAYER_WHOLE': ('LayerKind', 'SUNDER_LAYER_'),
         'SUNDER_PLAY_LOOP': ('PlayMode', 'SUNDER_PLAY_'), 'SUNDER_EASE_LINEAR': ('Easing', 'SUNDER_EASE_'),
         'SUNDER_LAYERS_NEAREST': ('TornLayers', 'SUNDER_LAYERS_'), 'SUNDER_PIECE_FROZEN': ('PieceMotion', 'SUNDER_PIECE_'),
         'SUNDER_AXES_PRINCIPAL': ('PieceAxes', 'SUNDER_AXES_'), 'SUNDER_SOLID_CLOSED': ('Solid', 'SUNDER_SOLID_'),
         'SUNDER_IN_BACKGROUND': ('SubmitFlags', 'SUNDER_'), 'SUNDER_COLLIDER_SPHERE': ('ColliderShape', 'SUNDER_COLLIDER_'),
         'SUNDER_JOINT_HINGE': ('JointKind', 'SUNDER_JOINT_'), 'SUNDER_WOUND_AGE': ('WoundChannel', 'SUNDER_WOUND_'),
         'SUNDER_FIELD_STRENGTH': ('TissueFactor', 'SUNDER_FIELD_'),
         'SUNDER_SEVERITY_NOTE': ('Severity', 'SUNDER_SEVERITY_'), 'SUNDER_EVIDENCE_EXACT': ('Evidence', 'SUNDER_EVIDENCE_'),
         'SUNDER_TRANSFER_CLOSEST_POINT': ('TransferMethod', 'SUNDER_TRANSFER_'), 'SUNDER_TRANSFER_COINCIDENT': ('TransferOutcome', 'SUNDER_TRANSFER_')}
FLAGS = ('Features', 'SubmitFlags')
SIGNED = ('Status', 'WeightPolicy')
# Arrays that the layer gives as views; Views.cs has a struct for each.
VIEWS = ('byte', 'uint', 'ulong', 'float', 'double', 'sunder_influence', 'sunder_draw_range', 'sunder_range', 'sunder_triangle_write')
VIEW_NAMES = {'byte': 'ByteView', 'uint': 'UIntView', 'ulong': 'ULongView', 'float': 'FloatView', 'double': 'DoubleView'}
KEYWORDS = ('base', 'bool', 'char', 'class', 'event', 'fixed', 'in', 'is', 'lock', 'new', 'object', 'out', 'params', 'ref', 'string')
TRUTH = re.compile(r'(is|has|adds|poses|keeps|flips|isolates)_|(unit_length|enters)$')


def fail(text):
    sys.exit(f'make_calls.py: {text}')


def pascal(name):
    return ''.join(word[:1].upper() + word[1:] for word in name.split('_'))


def camel(name):
    word = pascal(name)
    word = word[0].lower() + word[1:]
    return '@' + word if word in KEYWORDS else word


def summary(doc, indent=''):
    if not doc:
        return ''
    text = doc.replace('&', '&amp;').replace('<', '&lt;').replace('>', '&gt;')
    return f'{indent}/// <summary>{text}</summary>\n'


class Binding:
    def __init__(self, api):
        self.api = api
        self.structs = {one['name']: one for one in api['structs']}
        self.callbacks = {one['name']: one for one in api['callbacks']}
        self.types = {one['name']: one['type'] for one in api['types']}
        self.makers = {one['returns']: one['name'] for one in api['functions'] if '_default_' in one['name']}
        self.enums = {}
        for one in api['enums']:
            first = one['constants'][0]['name']
            self.enums[first] = ENUMS.get(first) or self.named_by_prefix([constant['name'] for constant in one['constants']])

    # ---- names ----

    @staticmethod
    def named_by_prefix(constants):
        """SUNDER_EASE_LINEAR, SUNDER_EASE_IN: Ease."""
        prefix = os.path.commonprefix(constants)
        prefix = prefix[:prefix.rindex('_') + 1]
        name = pascal(prefix[len('SUNDER_'):].strip('_').lower())
        if not name or name in (one for one, _ in ENUMS.values()):
            fail(f'the enum that begins with {constants[0]} has no name in C#: add it to ENUMS')
        return name, prefix

    def is_native(self, name):
        """Whether a struct has pointers, and is no set of options that a program fills in."""
        pointers = [field['type'].replace('const ', '').rstrip('* ') for field in self.structs[name]['fields'] if field['type'].endswith('*')]
        is_of_native = any(to in self.structs and self.is_native(to) for to in pointers)
        return bool(pointers) and (name not in self.makers or (is_of_native and not name.endswith('_options')))

    def struct_name(self, name):
        short = RENAMED.get(name) or pascal(name[len('sunder_'):])
        return f'Native.{short}' if self.is_native(name) else short

    def type_of(self, text):
        """A type of C in C#."""
        text = text.replace('const', '').replace(' ', '')
        if '(*' in text or text in self.callbacks:
            return 'IntPtr'
        bare = text.rstrip('*')
        stars = text[len(bare):]
        if bare == 'sunder_status':
            return 'Status' + stars
        if bare in self.structs:
            return self.struct_name(bare) + stars
        bare = self.types.get(bare, bare)
        if bare not in NUMBERS:
            fail(f'type {text}')
        return NUMBERS[bare] + stars

    def field_type(self, field):
        type_, name, doc = field['type'], field['name'], field['doc']
        if field['count'] > 1:
            return VECTORS[type_, field['count']]
        if name == 'weight_policy':
            return 'WeightPolicy'
        if type_ == 'uint32_t' and TRUTH.match(name):
            return 'NativeBool'
        if type_ == 'uint32_t':
            for first, (enum, prefix) in self.enums.items():
                if len(prefix) > len('SUNDER_') and (prefix in doc) and enum != 'TransferOutcome':
                    return enum
        return self.type_of(type_)

    # ---- files ----

    def enums_text(self):
        out = ['namespace Sunder\n{\n']
        for one in self.api['enums']:
            name, prefix = self.enums[one['constants'][0]['name']]
            out.append(summary(one['doc'], '  '))
            out.append(('  [System.Flags]\n' if name in FLAGS else '') + f'  public enum {name} : {"int" if name in SIGNED else "uint"}\n  {{\n')
            if name in FLAGS:
                out.append('    None = 0,\n')
            for constant in one['constants']:
                out.append(summary(constant['doc'], '    '))
                out.append(f'    {pascal(constant["name"][len(prefix):].lower())} = {constant["value"]},\n')
            out.append('  }\n\n')
        out.append('  public static class Constants\n  {\n')
        for name, value in self.api['constants'].items():
            out.append(f'    public const uint {pascal(name[len("SUNDER_"):].lower())} = 0x{value:X}u;\n')
        out.append('  }\n}\n')
        return ''.join(out)

    def struct_text(self, one):
        name = self.struct_name(one['name']).replace('Native.', '')
        out = [summary(one['doc'], '  '), f'  [StructLayout(LayoutKind.Sequential)]\n  public unsafe struct {name}\n  {{\n']
        for field in one['fields']:
            doc = field['doc'].replace('1: ', 'true: ', 1) if self.field_type(field) == 'NativeBool' else field['doc']
            out.append(summary(doc, '    '))
            out.append(f'    public {self.field_type(field)} {pascal(field["name"])};\n')
        if one['name'] in self.makers:
            # A library of another version may return another size: it is refused before.
            out.append(f'\n    /// <summary>Made by the library.</summary>\n    public static {name} Default\n    {{\n      get\n      {{\n'
                       f'        Library.Require();\n        return Native.NativeCalls.{self.makers[one["name"]]}();\n      }}\n    }}\n')
        elif one['fields'][0]['name'] == 'struct_size':
            out.append('\n    /// <summary>One that a call writes.</summary>\n'
                       f'    public static {name} Sized {{ get {{ {name} sized = new {name}(); sized.StructSize = (uint)sizeof({name}); return sized; }} }}\n')
        out.append('  }\n\n')
        return ''.join(out)

    def structs_text(self):
        out = ['using System;\nusing System.Runtime.InteropServices;\n\n']
        for namespace, native in (('Sunder', False), ('Sunder.Native', True)):
            out.append(f'namespace {namespace}\n{{\n')
            out += [self.struct_text(one) for one in self.api['structs'] if self.is_native(one['name']) == native]
            out.append('}\n\n')
        return ''.join(out)

    def calls_text(self):
        out = ['using System;\nusing System.Runtime.InteropServices;\n\nnamespace Sunder.Native\n{\n']
        for one in self.api['callbacks']:
            out.append(summary(one['doc'], '  '))
            parameters = ', '.join(f'{self.type_of(p["type"])} {camel(p["name"])}' for p in one['parameters'])
            out.append(f'  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]\n  public unsafe delegate {self.type_of(one["returns"])} '
                       f'{pascal(one["name"][len("sunder_"):])}({parameters});\n\n')
        out.append('  /// <summary>The functions of the C library. Texts are UTF-8 that ends with a zero.</summary>\n'
                   '  public static unsafe class NativeCalls\n  {\n'
                   '#if (UNITY_IOS || UNITY_WEBGL) && !UNITY_EDITOR\n    public const string Library = "__Internal";\n'
                   '#else\n    public const string Library = "sunder_c";\n#endif\n\n')
        for one in self.api['functions']:
            out.append(summary(one['doc'], '    '))
            parameters = ', '.join(f'{self.parameter_type(p)} {camel(p["name"])}' for p in one['parameters'])
            out.append('    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]\n'
                       f'    public static extern {self.type_of(one["returns"])} {one["name"]}({parameters});\n\n')
        out.append('  }\n}\n')
        return ''.join(out)

    def parameter_type(self, parameter):
        """Arrays of a length that C fixes are vectors, so that nobody hands in fewer numbers."""
        vector = VECTORS.get((parameter['type'].replace('const ', '').rstrip('*'), parameter['count']))
        return vector + '*' if vector and parameter['count'] > 1 else self.type_of(parameter['type'])

    def views_text(self):
        out = ['using System;\n\nnamespace Sunder\n{\n']
        for element in VIEWS:
            type_ = self.struct_name(element) if element in self.structs else element
            out.append(VIEW.replace('VIEW', VIEW_NAMES.get(element) or type_ + 'View').replace('ELEMENT', type_))
        out.append('}\n')
        return ''.join(out)

    def layouts_text(self):
        out = ['namespace Sunder.Tests\n{\n  static unsafe class Layouts\n  {\n    public static void Check(LayoutCheck check)\n    {\n'
               '      bool wide = sizeof(void*) == 8;\n']
        for one in self.api['structs']:
            name = self.struct_name(one['name']).replace('Native.', 'Sunder.Native.')
            out.append(f'      {{\n        {name} x;\n        check.Same("{one["name"]}", sizeof({name}), wide ? {one["size64"]} : {one["size32"]});\n')
            for field in one['fields']:
                out.append(f'        check.Same("{one["name"]}.{field["name"]}", (byte*)&x.{pascal(field["name"])} - (byte*)&x, '
                           f'wide ? {field["offset64"]} : {field["offset32"]});\n')
            out.append('      }\n')
        for one in self.api['enums']:
            name, prefix = self.enums[one['constants'][0]['name']]
            for constant in one['constants']:
                out.append(f'      check.Same("{constant["name"]}", (long){name}.{pascal(constant["name"][len(prefix):].lower())}, {constant["value"]});\n')
        out.append('    }\n  }\n}\n')
        return ''.join(out)


VIEW = '''  /// <summary>An array of the library, read-only and without a copy. Reading it after its time throws StaleViewException.</summary>
  public readonly unsafe struct VIEW
  {
    readonly ELEMENT* first;
    readonly int count;
    readonly Moment moment;

    internal VIEW(ELEMENT* first, ulong count, Moment moment)
    {
      this.first = first;
      this.count = first == null ? 0 : Epoch.CountOf(count);
      this.moment = moment;
    }

    /// <summary>0 for an array that is not there.</summary>
    public int Count { get { return count; } }

    public ELEMENT this[int index]
    {
      get
      {
        Check();
        if ((uint)index >= (uint)count) throw Epoch.OutOfRange(index, count);
        ELEMENT element = first[index];
        moment.KeepAlive();
        return element;
      }
    }

    /// <summary>The address of the first element, for loops that check once and then read many; null: the array is not there. Who reads
    /// there keeps the view's owner, a scene or a character, alive meanwhile: a field, a using or GC.KeepAlive() does.</summary>
    public ELEMENT* Pointer { get { Check(); return first; } }

    public void CopyTo(ELEMENT[] array, int at = 0)
    {
      Check();
      if (array == null) throw new ArgumentNullException("array");
      if (at < 0 || array.Length - at < count) throw new ArgumentException(Epoch.NoRoom(array.Length, at, count), "array");
      for (int i = 0; i < count; ++i) array[at + i] = first[i];
      moment.KeepAlive();
    }

    public ELEMENT[] ToArray()
    {
      ELEMENT[] array = new ELEMENT[count];
      CopyTo(array);
      return array;
    }

#if UNITY_2021_2_OR_NEWER || NETSTANDARD2_1_OR_GREATER || NETCOREAPP2_1_OR_GREATER || SUNDER_SPAN
    /// <summary>Checked now, and not again: use it up before the next call that changes what it shows, and keep the view's owner alive
    /// until then, as for Pointer.</summary>
    public ReadOnlySpan<ELEMENT> Span { get { Check(); return new ReadOnlySpan<ELEMENT>(first, count); } }
#endif

    void Check() { moment.Check(); }
  }

'''

HEAD = '// Written by bindings/csharp/make_calls.py from sunder_api.json.\n'


def main():
    if len(sys.argv) not in (3, 4) or sys.argv[3:] not in ([], ['--layouts']):
        fail('usage: make_calls.py API FOLDER [--layouts]')
    binding = Binding(json.loads(pathlib.Path(sys.argv[1]).read_text(encoding='utf-8')))
    folder = pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    files = {'Layouts.cs': binding.layouts_text} if sys.argv[3:] else {
        'Enums.cs': binding.enums_text, 'NativeCalls.cs': binding.calls_text, 'Structs.cs': binding.structs_text, 'Views.cs': binding.views_text}
    for name, text in files.items():
        (folder / name).write_text(HEAD + text(), encoding='utf-8')


main()
