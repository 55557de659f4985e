#!/usr/bin/env python3
"""Writes sunder_api.json from sunder_c.h: functions, structs with offsets, constants, documentation.

    make_api.py HEADER            prints the JSON
    make_api.py HEADER --checks   prints a C program that compares offsets and constants with a compiler's
    make_api.py HEADER --calls    prints C++ that calls each function with arguments of a source, for tests of misuse

Other bindings are generated from the JSON. The header keeps to the few forms that are read here; anything else is an
error. Offsets are for pointers of 8 bytes and of 4.
"""
import json
import re
import sys

NUMBERS = {"uint8_t": 1, "uint32_t": 4, "int32_t": 4, "uint64_t": 8, "int64_t": 8, "float": 4, "double": 8}


def fail(text):
    sys.exit(f"make_api.py: {text}")


def words_of(comment):
    """The text of a comment in one line."""
    lines = [line.strip().lstrip("*").strip() for line in comment.strip().splitlines()]
    return " ".join(line for line in lines if line)




class Api:
    def __init__(self, text):
        self.typedefs, self.callbacks, self.structs, self.enums, self.functions = {}, [], {}, [], []
        self.constants = {}
        for name, value in re.findall(r"#define (SUNDER_\w+) (0x[0-9A-Fa-f]+)u?\b", text):
            self.constants[name] = int(value, 16)
        body = re.sub(r"^\s*#.*?(?<!\\)$", "", text, flags=re.M)
        body = body[body.index('extern "C" {') + len('extern "C" {'):]
        self.lines = body
        self.read(body)

    def read(self, body):
        position, doc, last = 0, "", None
        pattern = re.compile(
            r"\s*(?:(?P<comment>/\*.*?\*/)|(?P<struct>typedef struct (\w+) \{(.*?)\} (\w+);)"
            r"|(?P<enum>enum \{(.*?)\};)|(?P<callback>typedef ([\w* ]+?) ?\(\*(\w+)\)\((.*?)\);)"
            r"|(?P<alias>typedef (\w+)\s+(\w+);)|(?P<function>SUNDER_C_API ([\w* ]+?)\b(\w+)\((.*?)\);)|(?P<end>\}))", re.S)
        while position < len(body):
            if not body[position:].strip():
                break
            match = pattern.match(body, position)
            if not match:
                fail("cannot read: " + body[position:position + 200].strip())
            newline = "\n" in body[position:match.start() + len(match.group()) - len(match.group().lstrip())]
            position = match.end()
            if match.group("comment"):
                text = words_of(match.group("comment")[2:-2])
                if not newline and last is not None:
                    last["doc"] = (last.get("doc", "") + " " + text).strip()
                    doc = ""
                else:
                    doc = "" if text.startswith("----") else text
                continue
            if match.group("end"):
                break
            last = self.add(match, doc)
            doc = ""

    def add(self, match, doc):
        if match.group("struct"):
            name = match.group(3)
            if name != match.group(5):
                fail("struct " + name)
            one = {"name": name, "doc": doc, "fields": self.fields(match.group(4))}
            self.structs[name] = one
            return one
        if match.group("enum"):
            one = {"doc": doc, "constants": self.enumerators(match.group(7))}
            self.enums.append(one)
            return one
        if match.group("callback"):
            one = {"name": match.group(10), "doc": doc, "returns": match.group(9),
                   "parameters": self.parameters(match.group(11))}
            self.callbacks.append(one)
            return one
        if match.group("alias"):
            one = {"name": match.group(14), "type": match.group(13), "doc": doc}
            self.typedefs[one["name"]] = one
            return one
        one = {"name": match.group(17), "doc": doc, "returns": match.group(16).strip(),
               "parameters": self.parameters(match.group(18))}
        self.functions.append(one)
        return one

    def enumerators(self, body):
        constants = []
        for name, value, comment in re.findall(r"(SUNDER_\w+) = (-?\d+),?\s*(/\*.*?\*/)?", body, re.S):
            self.constants[name] = int(value)
            constants.append({"name": name, "value": int(value), "doc": words_of(comment[2:-2]) if comment else ""})
        return constants

    def fields(self, body):
        fields = []
        code = r"(?P<type>(?:const )?\w+(?: ?\*)?(?: ?const ?\*)?) ?(?P<names>[^;/]+);\s*(?P<comment>/\*.*?\*/(?=\s|$))?"
        for match in re.finditer(code, body, re.S):
            doc = words_of(match.group("comment")[2:-2]) if match.group("comment") else ""
            for name in match.group("names").split(","):
                array = re.match(r"\s*(\w+)\[(\d+)\]$", name)
                fields.append({"name": array.group(1) if array else name.strip(),
                               "type": " ".join(match.group("type").replace("*", " *").split()).replace(" *", "*"),
                               "count": int(array.group(2)) if array else 1, "doc": doc})
        left = re.sub(r"/\*.*?\*/", "", re.sub(code, "", body, flags=re.S), flags=re.S).strip()
        if left:
            fail("fields: " + left)
        return fields

    def parameters(self, body):
        parameters = []
        depth, start = 0, 0
        parts = []
        for i, c in enumerate(body + ","):
            depth += (c == "(") - (c == ")")
            if c == "," and depth == 0:
                parts.append(" ".join((body + ",")[start:i].split()))
                start = i + 1
        for part in parts:
            if part in ("void", ""):
                continue
            function = re.match(r"void \(\*(\w+)\)\(void\* ?\w*\)$", part)
            if function:
                parameters.append({"name": function.group(1), "type": "void (*)(void*)", "count": 1})
                continue
            one = re.match(r"(.*?[\s*])(\w+)(?:\[(\d+)\])?$", part)
            if not one:
                fail("parameter: " + part)
            type_ = one.group(1).strip()
            parameters.append({"name": one.group(2), "type": type_ + ("*" if one.group(3) else ""),
                               "count": int(one.group(3) or 1)})
        return parameters

    def size_and_alignment(self, type_, pointer):
        if type_.endswith("*") or any(type_ == one["name"] for one in self.callbacks):
            return pointer, pointer
        if type_ in self.typedefs:
            return self.size_and_alignment(self.typedefs[type_]["type"], pointer)
        if type_ in self.structs:
            return self.layout(self.structs[type_], pointer)
        if type_ not in NUMBERS:
            fail("type " + type_)
        return NUMBERS[type_], NUMBERS[type_]

    def layout(self, struct, pointer):
        at, most = 0, 1
        for field in struct["fields"]:
            size, alignment = self.size_and_alignment(field["type"], pointer)
            aligned = -(-at // alignment) * alignment
            if pointer == 8 and aligned != at:
                fail(f"{struct['name']}.{field['name']}: padding before it")
            field[f"offset{pointer * 8}"] = aligned
            at, most = aligned + size * field["count"], max(most, alignment)
        size = -(-at // most) * most
        if pointer == 8 and size != at:
            fail(f"{struct['name']}: padding at its end")
        struct[f"size{pointer * 8}"] = size
        return size, most

    def json(self):
        for struct in self.structs.values():
            for pointer in (8, 4):
                self.layout(struct, pointer)
        return {"version": self.constants["SUNDER_C_VERSION"], "types": list(self.typedefs.values()),
                "callbacks": self.callbacks, "enums": self.enums,
                "constants": {name: self.constants[name] for name in ("SUNDER_NONE", "SUNDER_C_VERSION")},
                "structs": list(self.structs.values()), "functions": self.functions}


def text_of(api):
    """JSON with one line per entry, so that changes are easy to see."""
    def lines(value):
        if not isinstance(value, list):
            return json.dumps(value)
        return "[\n" + ",\n".join("  " + json.dumps(entry) for entry in value) + "\n ]"
    return "{\n" + ",\n".join(f" {json.dumps(key)}: {lines(value)}" for key, value in api.items()) + "\n}"


def checks(api):
    lines = ["#include <stddef.h>", "#include <sunder_c.h>",
             "#define SAME(a, b) _Static_assert((a) == (b), #a)", "#define BITS (sizeof(void*) * 8)"]
    for struct in api["structs"]:
        lines.append(f"SAME(sizeof({struct['name']}), BITS == 64 ? {struct['size64']} : {struct['size32']});")
        for field in struct["fields"]:
            lines.append(f"SAME(offsetof({struct['name']}, {field['name']}), "
                         f"BITS == 64 ? {field['offset64']} : {field['offset32']});")
    for enum in api["enums"]:
        lines += [f"SAME({one['name']}, {one['value']});" for one in enum["constants"]]
    for function in api["functions"]:
        parameters = ", ".join(one["type"] if "(*)" not in one["type"] else "void (*)(void*)"
                               for one in function["parameters"]) or "void"
        lines.append(f"{function['returns']} (*const check_{function['name']})({parameters}) = {function['name']};")
    lines.append("int main(void) { return 0; }")
    return "\n".join(lines)


def calls(api):
    """A table of functions of a template argument, which has one member template per kind of argument."""
    structs = {one["name"] for one in api["structs"]}
    defaults = {one["returns"]: one["name"] for one in api["functions"] if "_default_" in one["name"]}
    handles = {one["name"] for one in api["types"] if one["name"] != "sunder_status"}
    callbacks = {one["name"] for one in api["callbacks"]}

    def argument(parameter):
        type_, name = parameter["type"], parameter["name"]
        bare = type_.replace("const ", "").rstrip("*")
        if type_ in callbacks:
            return "nullptr"
        if type_ in handles:
            return f"source.template handle<{type_}>(\"{type_}\")"
        if type_ == bare + "*" and bare in handles:
            return f"source.template handle_out<{bare}>(\"{bare}\")"
        if bare in structs and type_.count("*") == 1:
            made = f"{defaults[bare]}()" if bare in defaults else f"source.template sized<{bare}>()"
            return f"source.structure({made})"
        if type_.endswith("*"):
            return f"source.template pointer<{type_}>()"
        return f"source.template number<{type_}>(\"{name}\")"

    lines = ["template <class Source>", "struct Calls {"]
    names = []
    for function in api["functions"]:
        if function["returns"] != "sunder_status" or function["name"] == "sunder_check_abi":
            continue
        names.append(function["name"])
        lines.append(f"  static sunder_status {function['name']}_(Source& source) {{ return {function['name']}("
                     + ", ".join(argument(one) for one in function["parameters"]) + "); }")
    lines.append("  struct Call { const char* name; sunder_status (*call)(Source&); };")
    lines.append("  static constexpr Call kAll[] = {" + ", ".join(f'{{"{one}", {one}_}}' for one in names) + "};")
    lines.append("};")
    return "\n".join(lines)


def main():
    forms = {"--checks": checks, "--calls": calls}
    if len(sys.argv) not in (2, 3) or sys.argv[2:] and sys.argv[2] not in forms:
        fail("usage: make_api.py HEADER [--checks | --calls]")
    with open(sys.argv[1], encoding="utf-8") as file:
        api = Api(file.read()).json()
    print(forms[sys.argv[2]](api) if len(sys.argv) == 3 else text_of(api))


main()
