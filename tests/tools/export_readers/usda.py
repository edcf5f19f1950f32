"""A strict reader of the text form of Universal Scene Description: what it does not know, or what is not as it must be, is an error.

It knows what a scene of moving meshes needs: the layer's metadata, prims with references to classes beside them, attributes with a value or time samples, and
checks each value against its type. read(path) gives a Stage.
"""
import re

TOKEN = re.compile(r"""\s*(?:\#[^\n]*\n\s*)*(?:
    (?P<string>"(?:[^"\\\n]|\\.)*") | (?P<path></[A-Za-z0-9_/]+>) |
    (?P<number>[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?) | (?P<word>[A-Za-z_][A-Za-z0-9_:.]*) | (?P<mark>\[\]|[()\[\]{}=:,]) )""", re.X)

# numbers in one value of each type; None: text
TYPES = {"int": 1, "float": 1, "double": 1, "token": None, "string": None, "point3f": 3, "float3": 3, "color3f": 3, "double3": 3, "quatd": 4}
STAGE = {"defaultPrim": str, "doc": str, "endTimeCode": float, "framesPerSecond": float, "metersPerUnit": float, "startTimeCode": float, "timeCodesPerSecond": float,
         "upAxis": str}
MESH = {"faceVertexCounts": "int[]", "faceVertexIndices": "int[]", "points": "point3f[]", "extent": "float3[]", "subdivisionScheme": "token",
        "primvars:displayColor": "color3f[]"}
XFORM = {"xformOp:translate": "double3", "xformOp:orient": "quatd", "xformOpOrder": "token[]"}


class Bad(Exception):
    pass


class Attribute:
    def __init__(self, kind, value=None, samples=None):
        self.kind, self.value, self.samples = kind, value, samples

    def at(self, code):
        if self.samples is None:
            return self.value
        if code not in self.samples:
            raise Bad(f"no time sample at {code}")
        return self.samples[code]


class Prim:
    def __init__(self, specifier, kind, name):
        self.specifier, self.kind, self.name = specifier, kind, name
        self.references, self.custom, self.attributes, self.children = [], {}, {}, {}


class Stage:
    def __init__(self):
        self.metadata, self.prims = {}, {}


class Reader:
    def __init__(self, text):
        if not text.startswith("#usda 1.0\n"):
            raise Bad("the first line is not #usda 1.0")
        self.tokens, at = [], len("#usda 1.0\n")
        while text[at:].strip():
            found = TOKEN.match(text, at)
            if not found:
                raise Bad(f"line {text.count(chr(10), 0, at) + 1}: {text[at:at + 30]!r} is no token")
            self.tokens.append((found.lastgroup, found.group(found.lastgroup)))
            at = found.end()
        self.tokens.append(("end", ""))
        self.at = 0

    def peek(self):
        return self.tokens[self.at]

    def next(self, kind=None, text=None):
        token = self.tokens[self.at]
        if (kind and token[0] != kind) or (text and token[1] != text):
            raise Bad(f"token {self.at}: {token[1]!r} where {text or kind} is wanted")
        self.at += 1
        return token[1]

    def skip(self, text):
        if self.peek() == ("mark", text):
            self.at += 1
            return True
        return False

    def string(self):
        return self.next("string")[1:-1]

    def name(self):
        name = self.string()
        if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", name):
            raise Bad(f"{name!r} is no prim's name")
        return name

    # values
    def single(self, kind):
        size = TYPES[kind]
        if size is None:
            return self.string()
        if size == 1:
            text = self.next("number")
            return int(text) if kind == "int" else float(text)
        self.next("mark", "(")
        numbers = []
        while not self.skip(")"):
            if numbers:
                self.next("mark", ",")
            numbers.append(float(self.next("number")))
        if len(numbers) != size:
            raise Bad(f"{len(numbers)} numbers in a {kind}")
        return tuple(numbers)

    def value(self, kind):
        if not kind.endswith("[]"):
            return self.single(kind)
        self.next("mark", "[")
        values = []
        while not self.skip("]"):
            if values:
                self.next("mark", ",")
            values.append(self.single(kind[:-2]))
        return values

    def samples(self, kind):
        self.next("mark", "{")
        samples, before = {}, None
        while not self.skip("}"):
            code = float(self.next("number"))
            if before is not None and code <= before:
                raise Bad(f"time sample {code} after {before}")
            before = code
            self.next("mark", ":")
            samples[code] = self.value(kind)
            self.next("mark", ",")
        if not samples:
            raise Bad("no time samples")
        return samples

    # parts
    def stage(self):
        stage = Stage()
        self.next("mark", "(")
        while not self.skip(")"):
            key = self.next("word")
            if key not in STAGE or key in stage.metadata:
                raise Bad(f"metadata {key}")
            self.next("mark", "=")
            stage.metadata[key] = self.string() if STAGE[key] is str else float(self.next("number"))
        missing = set(STAGE) - set(stage.metadata)
        if missing:
            raise Bad(f"no metadata {missing}")
        while self.peek()[0] != "end":
            prim = self.prim()
            if prim.name in stage.prims:
                raise Bad(f"two prims {prim.name}")
            stage.prims[prim.name] = prim
        return stage

    def prim(self):
        specifier = self.next("word")
        if specifier not in ("def", "class"):
            raise Bad(f"specifier {specifier}")
        prim = Prim(specifier, self.next("word"), self.name())
        if prim.kind not in ("Xform", "Mesh"):
            raise Bad(f"prim of type {prim.kind}")
        if self.skip("("):
            while not self.skip(")"):
                self.prim_metadata(prim)
        self.next("mark", "{")
        while not self.skip("}"):
            if self.peek()[1] in ("def", "class"):
                child = self.prim()
                if child.name in prim.children:
                    raise Bad(f"two prims {child.name}")
                prim.children[child.name] = child
            else:
                self.attribute(prim)
        return prim

    def prim_metadata(self, prim):
        key = self.next("word")
        if key == "prepend":
            self.next("word", "references")
            self.next("mark", "=")
            prim.references.append(self.next("path")[1:-1])
        elif key == "customData":
            self.next("mark", "=")
            self.next("mark", "{")
            while not self.skip("}"):
                self.next("word", "string")
                name = self.next("word")
                self.next("mark", "=")
                prim.custom[name] = self.string()
        else:
            raise Bad(f"metadata {key} of {prim.name}")

    def attribute(self, prim):
        uniform = self.peek()[1] == "uniform"
        if uniform:
            self.next()
        kind = self.next("word")
        if self.skip("[]"):
            kind += "[]"
        name = self.next("word")
        sampled = name.endswith(".timeSamples")
        name = name.removesuffix(".timeSamples")
        known = {**(MESH if prim.kind == "Mesh" else {}), **XFORM}
        if known.get(name) != kind:
            raise Bad(f"attribute {kind} {name} of {prim.name}")
        if uniform != (name in ("subdivisionScheme", "xformOpOrder")) or (uniform and sampled) or name in prim.attributes:
            raise Bad(f"how {name} of {prim.name} is declared")
        self.next("mark", "=")
        prim.attributes[name] = Attribute(kind, samples=self.samples(kind)) if sampled else Attribute(kind, self.value(kind))


def compose(stage, prim):
    """The prim's attributes, those of what it refers to among them."""
    attributes = {}
    for path in prim.references:
        target = stage.prims.get(path.strip("/"))
        if target is None or target.specifier != "class" or target.kind != prim.kind:
            raise Bad(f"{prim.name} refers to {path}")
        attributes.update(compose(stage, target))
    attributes.update(prim.attributes)
    return attributes


def check_mesh(name, attributes):
    for needed in ("faceVertexCounts", "faceVertexIndices", "points", "extent", "subdivisionScheme"):
        if needed not in attributes:
            raise Bad(f"{name} has no {needed}")
    counts, corners = attributes["faceVertexCounts"].value, attributes["faceVertexIndices"].value
    if sum(counts) != len(corners) or min(counts) < 3 or attributes["subdivisionScheme"].value != "none":
        raise Bad(f"faces of {name}")
    points, extent = attributes["points"], attributes["extent"]
    if (points.samples is None) != (extent.samples is None) or (points.samples and list(points.samples) != list(extent.samples)):
        raise Bad(f"{name}: extent at other times than points")
    for code in points.samples or [None]:
        now, box = points.at(code), extent.at(code)
        if min(corners) < 0 or max(corners) >= len(now) or len(box) != 2:
            raise Bad(f"corners of {name}")
        for k in range(3):
            if min(p[k] for p in now) != box[0][k] or max(p[k] for p in now) != box[1][k]:
                raise Bad(f"extent of {name}")
    order = attributes.get("xformOpOrder")
    used = [a for a in attributes if a.startswith("xformOp:")]
    if sorted(order.value if order else []) != sorted(used):
        raise Bad(f"xformOpOrder of {name}")


def read(path):
    stage = Reader(open(path).read()).stage()
    if stage.metadata["defaultPrim"] not in stage.prims:
        raise Bad("defaultPrim is not there")
    for prim in stage.prims.values():
        for mesh in [prim, *prim.children.values()]:
            if mesh.kind == "Mesh":
                check_mesh(mesh.name, compose(stage, mesh))
    return stage
