"""The C library as ctypes: structs, constants and functions are made from sunder_api.json when the package is imported.

Nothing here is written per function, so a new function of sunder_c.h appears by itself. `call()` raises SunderError.
"""
import ctypes
import json
import os
import pathlib
import re

from .errors import SunderError

_HERE = pathlib.Path(__file__).resolve().parent
_NUMBERS = {
    'char': ctypes.c_char, 'float': ctypes.c_float, 'double': ctypes.c_double, 'int32_t': ctypes.c_int32, 'uint8_t': ctypes.c_uint8,
    'uint32_t': ctypes.c_uint32, 'uint64_t': ctypes.c_uint64}


def _find_library():
    """SUNDER_C_LIBRARY, or the library that was installed with the package."""
    if named := os.environ.get('SUNDER_C_LIBRARY'):
        return named
    for pattern in ('libsunder_c.so*', 'libsunder_c*.dylib', '*sunder_c.dll'):
        for file in sorted(_HERE.glob(pattern)):
            return str(file)
    raise ImportError(f'libsunder_c is not in {_HERE}; install the package, or set SUNDER_C_LIBRARY')


class Abi:
    """Types and functions of the C library by their names, without the prefix `sunder_`."""

    def __init__(self):
        api = json.loads((_HERE / 'sunder_api.json').read_text(encoding='utf-8'))
        self.constants = dict(api['constants'])
        for enum in api['enums']:
            self.constants.update((constant['name'], constant['value']) for constant in enum['constants'])
        self._types = {entry['name']: entry['type'] for entry in api['types']}
        self._callbacks = {}
        self.structs = {}
        for callback in api['callbacks']:
            self._callbacks[callback['name']] = ctypes.CFUNCTYPE(
                self._type(callback['returns']), *(self._type(parameter['type']) for parameter in callback['parameters']))
        for entry in api['structs']:
            fields = [(field['name'], self._type(field['type']) * field['count'] if field['count'] > 1 else self._type(field['type']))
                      for field in entry['fields']]
            struct = type(entry['name'], (ctypes.Structure,), {'_fields_': fields, '__doc__': entry['doc']})
            if ctypes.sizeof(struct) != entry[f'size{8 * ctypes.sizeof(ctypes.c_void_p)}']:
                raise ImportError(f'{entry["name"]} has {ctypes.sizeof(struct)} bytes here')
            self.structs[entry['name']] = struct
        library = ctypes.CDLL(_find_library())
        self._functions = {}
        for entry in api['functions']:
            function = getattr(library, entry['name'])
            function.restype = self._type(entry['returns'])
            function.argtypes = [self._type(parameter['type']) for parameter in entry['parameters']]
            function.__doc__ = entry['doc']
            self._functions[entry['name']] = function
        self.call('check_abi', api['version'], 0)

    def _type(self, text):
        text = text.replace('const ', '').replace(' const', '').strip()
        if text in ('void', ''):
            return None
        if text in self._callbacks:
            return self._callbacks[text]
        if '(*' in text or text == 'void*':
            return ctypes.c_void_p
        if text == 'char*':
            return ctypes.c_char_p
        if match := re.fullmatch(r'(.*?)\s*\*', text):
            return ctypes.POINTER(self._type(match.group(1)))
        if text in self.structs:
            return self.structs[text]
        return _NUMBERS[self._types.get(text, text)]

    def constant(self, name):
        return self.constants[f'SUNDER_{name}']

    def new(self, name, **values):
        """A struct: its defaults, or its size alone, and then the given fields."""
        make = self._functions.get(f'sunder_default_{name}')
        struct = make() if make else self.structs[f'sunder_{name}']()
        if not make and hasattr(struct, 'struct_size'):
            struct.struct_size = ctypes.sizeof(struct)
        kinds = {field: kind for field, kind in struct._fields_ if field not in ('struct_size', 'reserved')}
        for field, value in values.items():
            if field not in kinds:
                raise TypeError(f'{name} has no option {field!r}; it has {", ".join(kinds)}')
            kind = kinds[field]
            if isinstance(kind, type) and issubclass(kind, ctypes.Array):
                if len(value) != len(getattr(struct, field)):
                    raise ValueError(f'{field} has {len(value)} numbers; it must have {len(getattr(struct, field))}')
                value = kind(*value)
            setattr(struct, field, value)
        return struct

    def type(self, name):
        return self.structs[f'sunder_{name}']

    def plain(self, name, *arguments):
        """Calls a function that returns something other than a status."""
        return self._functions[f'sunder_{name}'](*arguments)

    def call(self, name, *arguments):
        """Calls a function. Raises SunderError if it fails."""
        status = self._functions[f'sunder_{name}'](*arguments)
        if status != 0:
            raise SunderError(status, self.plain('status_name', status).decode(), self.plain('last_error').decode('utf-8', 'replace'),
                              self.plain('last_error_index'))

    def output(self, name, *arguments, kind=ctypes.c_uint32):
        """Calls a function whose last parameter is a number that it writes, and returns the number."""
        value = kind()
        self.call(name, *arguments, ctypes.byref(value))
        return value.value

    def take_bytes(self, handle):
        """A copy of bytes that a call has made; the library's are destroyed."""
        data, size = ctypes.POINTER(ctypes.c_uint8)(), ctypes.c_uint64()
        self.call('get_bytes', handle, ctypes.byref(data), ctypes.byref(size))
        try:
            return ctypes.string_at(data, size.value)
        finally:
            self.call('destroy_bytes', handle)


abi = Abi()
