# SPDX-License-Identifier: MIT
"""Reads an IFC file with IfcOpenShell; prints the building as docs/formats/building.md has it.

`crossnav scene import FILE.ifc` runs this text with `python3 -c`, with limits of time and memory.
Exit status 0: standard output is the building. 1: one line with the error. 3: the
package ifcopenshell is missing. World frame, z up, metres.
"""
import sys

sys.path = [p for p in sys.path if p]  # modules are never taken from the current folder

import json  # noqa: E402
import os  # noqa: E402

OUT = os.fdopen(os.dup(1), "w", encoding="utf-8")  # IfcOpenShell prints, too
os.dup2(2, 1)

MAX_PRODUCTS = 50_000
MAX_TRIANGLES = 1_000_000
MAX_NAME = 200  # characters
REACH_M = 250.0  # from the middle of the building; farther elements are left out
FAR_M = 1000.0  # of the middle from the origin; farther buildings are moved back
HIGH_M = 100.0
MAX_WALL_M = 0.6  # from the middle of a door to a face of its wall
BOTTOM_M = 0.3  # height of the part of a space that is its ground

# Drawn classes: class -> kind, the first match. Other classes are furniture or "".
KINDS = (
    ("IfcWall", "wall"), ("IfcCurtainWall", "wall"), ("IfcSlab", "floor"), ("IfcRoof", "roof"),
    ("IfcCovering", "ceiling"), ("IfcStair", "stairs"), ("IfcStairFlight", "stairs"),
    ("IfcRamp", "ramp"), ("IfcRampFlight", "ramp"), ("IfcRailing", "railing"),
    ("IfcWindow", "window"), ("IfcDoor", "door"), ("IfcColumn", "column"), ("IfcBeam", "beam"),
    ("IfcMember", "beam"), ("IfcPlate", "window"), ("IfcChimney", "column"),
    ("IfcFurnishingElement", "furniture"), ("IfcDistributionElement", "furniture"),
    ("IfcBuildingElementProxy", "furniture"), ("IfcTransportElement", "furniture"),
    ("IfcElement", "other"))
SLABS = {"ROOF": "roof", "LANDING": "stairs"}
COVERINGS = {"FLOORING": "floor", "CEILING": "ceiling"}
LEFT_OUT = ("IfcOpeningElement", "IfcFeatureElement", "IfcVirtualElement", "IfcReinforcingElement",
            "IfcReinforcingBar", "IfcReinforcingMesh", "IfcTendon", "IfcFooting", "IfcPile",
            "IfcFastener", "IfcMechanicalFastener", "IfcDistributionPort", "IfcPort",
            "IfcElementAssembly", "IfcDiscreteAccessory", "IfcGeographicElement", "IfcCivilElement",
            "IfcFlowSegment", "IfcFlowFitting")


class Refused(Exception):
    """An error in the file."""


def is_a(entity, names):
    for name in names:
        try:
            if entity.is_a(name):
                return True
        except RuntimeError:  # no such class in this schema
            continue
    return False


def predefined(entity):
    """Its predefined type, or that of its type; IFC 2x3 has most of them at the type."""
    from ifcopenshell.util import element as util
    for one in (entity, util.get_type(entity)):
        name = getattr(one, "PredefinedType", None) if one is not None else None
        if name and name not in ("NOTDEFINED", "USERDEFINED"):
            return name
    return ""


def kind_of(entity):
    for name, kind in KINDS:
        if not is_a(entity, (name,)):
            continue
        if kind == "floor":
            return SLABS.get(predefined(entity), kind)
        if kind == "ceiling":
            return COVERINGS.get(predefined(entity), "wall")
        return kind
    return "other"


def names_of(entity):
    """Names that may give its kind, the most certain first."""
    from ifcopenshell.util import element as util
    kind = util.get_type(entity)
    names = [predefined(entity), getattr(entity, "LongName", None), entity.Name,
             getattr(entity, "ObjectType", None), getattr(kind, "Name", None),
             getattr(kind, "ElementType", None), entity.Description]
    return list(dict.fromkeys(str(n)[:MAX_NAME] for n in names if n))


class Building:
    def __init__(self, path):
        self.path = path
        self.notes = []
        self.colours = {}
        self.shapes = {}  # step id -> (vertices, triangles, colours, matrix)
        self.triangles = 0

    def open(self):
        import ifcopenshell
        try:
            with open(self.path, "rb") as file:
                head = file.read(256)
                file.seek(max(0, os.path.getsize(self.path) - 4096))
                tail = file.read()
        except OSError as error:
            raise Refused(f"cannot be read: {error.strerror}") from None
        if b"ISO-10303-21" not in head:
            raise Refused("is no IFC file in the STEP format (it does not begin with ISO-10303-21)")
        if b"END-ISO-10303-21" not in tail:
            raise Refused("ends in the middle (no END-ISO-10303-21); export it again")
        try:
            self.file = ifcopenshell.open(self.path)
            self.schema = self.file.schema
            products = len(self.file.by_type("IfcProduct"))
        except MemoryError:
            raise
        except Exception as error:  # the library raises many types
            raise Refused("is not readable IFC: " + " ".join(str(error).split())[:200]) from None
        if products == 0:
            raise Refused("holds no building (no IfcProduct that can be read); export it again")
        if products > MAX_PRODUCTS:
            raise Refused(f"has more than {MAX_PRODUCTS} products; export single buildings")

    def make_shapes(self):
        import ifcopenshell.geom
        import numpy
        wanted = [p for p in self.file.by_type("IfcProduct")
                  if getattr(p, "Representation", None)
                  and (is_a(p, ("IfcSpace",)) or is_a(p, ("IfcElement",)) and not is_a(p, LEFT_OUT))]
        self.wanted = sorted(wanted, key=lambda p: p.id())
        if not self.wanted:
            raise Refused("has no walls, spaces or other elements with a shape")
        settings = ifcopenshell.geom.settings()
        settings.set("apply-default-materials", False)
        shapes = ifcopenshell.geom.iterator(settings, self.file, 1, include=self.wanted)
        more = shapes.initialize()
        while more:
            shape = shapes.get()
            mesh = shape.geometry
            matrix = numpy.array(shape.transformation.matrix, float).reshape(4, 4).T
            vertices = numpy.array(mesh.verts, float).reshape(-1, 3)
            vertices = vertices @ matrix[:3, :3].T + matrix[:3, 3]
            faces = numpy.array(mesh.faces, int).reshape(-1, 3)
            if len(faces) and numpy.isfinite(vertices).all():
                palette = [self.colour(m) for m in mesh.materials] + [-1]
                colours = [palette[i] if 0 <= i < len(palette) else -1 for i in mesh.material_ids]
                colours = (colours + [-1] * len(faces))[:len(faces)]
                self.shapes[shape.id] = [vertices, faces, colours, matrix]
                self.triangles += len(faces)
            if self.triangles > MAX_TRIANGLES:
                raise Refused(f"has more than {MAX_TRIANGLES} triangles; export single storeys")
            more = shapes.next()
        lost = sum(p.id() not in self.shapes for p in self.wanted)
        if lost:
            self.notes.append(f"{lost} elements without a shape that can be made are left out")
        if not self.shapes:
            raise Refused("has no element whose shape can be made; export it again")

    def colour(self, material):
        """Index of its colour, -1 = none."""
        try:
            rgb = [material.diffuse.r(), material.diffuse.g(), material.diffuse.b()]
            key = tuple(int(round(255 * min(1.0, max(0.0, float(c))))) for c in rgb)
        except (AttributeError, TypeError, ValueError, OverflowError):
            return -1
        return self.colours.setdefault(key, len(self.colours))

    def move_near(self):
        """Drops elements far from the others and moves the others to the origin."""
        import numpy
        middles = {i: 0.5 * (s[0].min(0) + s[0].max(0)) for i, s in self.shapes.items()}
        middle = numpy.median(numpy.array(list(middles.values())), axis=0)
        far = [i for i, s in self.shapes.items() if abs(s[0] - middle).max() > REACH_M]
        for i in far:
            del self.shapes[i]
        if far:
            self.notes.append(
                f"{len(far)} elements further than {REACH_M:.0f} m from the rest are left out")
        if not self.shapes:
            raise Refused(f"has no two elements within {REACH_M:.0f} m of each other")
        self.shift = numpy.zeros(3)
        if abs(middle[:2]).max() > FAR_M:
            self.shift[:2] = -numpy.round(middle[:2])
        if abs(middle[2]) > HIGH_M:
            self.shift[2] = -numpy.round(min(s[0][:, 2].min() for s in self.shapes.values()))
        if self.shift.any():
            x, y, z = self.shift
            self.notes.append(f"the building is moved by {x:.0f}, {y:.0f}, {z:.0f} m to the origin")
            for shape in self.shapes.values():
                shape[0] = shape[0] + self.shift

    def storey_index(self):
        from ifcopenshell.util import placement, unit
        scale = unit.calculate_unit_scale(self.file)
        found = []
        for storey in self.file.by_type("IfcBuildingStorey"):
            height = (storey.Elevation or 0.0) * scale
            if storey.ObjectPlacement is not None:
                height = placement.get_local_placement(storey.ObjectPlacement)[2][3] * scale
            found.append((float(height) + float(self.shift[2]), storey.id(), storey.Name or "storey"))
        found.sort()
        self.storey_of_id = {i: k for k, (_, i, _) in enumerate(found)}
        return [{"name": str(name)[:MAX_NAME], "floor_m": round(z, 4)} for z, _, name in found]

    def storey_of(self, entity):
        from ifcopenshell.util import element as util
        for _ in range(16):
            if entity is None or entity.id() in self.storey_of_id:
                break
            entity = util.get_container(entity) or util.get_aggregate(entity)
        return -1 if entity is None else self.storey_of_id.get(entity.id(), -1)

    def space(self, entity):
        vertices, faces, _, _ = self.shapes[entity.id()]
        outline = outline_of(vertices, faces)
        if outline is None:
            self.notes.append(f"the space '{entity.Name}' has no ground and is left out")
            return None
        low, high = vertices[:, 2].min(), vertices[:, 2].max()
        outside = "EXTERNAL" in (str(getattr(entity, "InteriorOrExteriorSpace", "")),
                                 str(getattr(entity, "PredefinedType", "")))
        return {"names": names_of(entity), "storey": self.storey_of(entity),
                "floor_m": round(float(low), 4), "height_m": round(float(high - low), 4),
                "outside": outside, "outline": outline}

    def element(self, kind, entity, parts):
        """One element of the shapes of `parts`."""
        vertices, triangles, colours = [], [], []
        for part in parts:
            v, f, c, _ = self.shapes[part.id()]
            triangles += (f + len(vertices) // 3).ravel().tolist()
            vertices += rounded(v)
            colours += c
        made = {"kind": kind, "names": names_of(entity),
                "storey": self.storey_of(entity)}
        if kind in ("door", "window", "furniture", "stairs"):
            matrix = self.shapes[parts[0].id()][3]
            made["axis"] = [round(float(matrix[0][0]), 6), round(float(matrix[1][0]), 6)]
        if kind == "door":
            made.update(self.door(entity))
        made["vertices"], made["triangles"] = vertices, triangles
        made["colours"] = colours[0] if len(set(colours)) == 1 else colours
        return made

    def door(self, entity):
        """How it opens, where the wall begins and ends across it."""
        from ifcopenshell.util import element as util
        kind = util.get_type(entity)
        opens = getattr(entity, "OperationType", None) or getattr(kind, "OperationType", None)
        made = {"opens": str(opens or "")}
        try:
            host = entity.FillsVoids[0].RelatingOpeningElement.VoidsElements[0]
            wall = self.shapes[host.RelatingBuildingElement.id()][0]
        except (IndexError, KeyError, AttributeError):
            return made
        vertices, _, _, matrix = self.shapes[entity.id()]
        x, y = matrix[:2, 0], matrix[:2, 1]
        along, middle = vertices[:, :2] @ x, (vertices[:, :2] @ y).mean()
        near = wall[(wall[:, :2] @ x > along.min() - 0.1) & (wall[:, :2] @ x < along.max() + 0.1)
                    & (abs(wall[:, :2] @ y - middle) < MAX_WALL_M)]
        if len(near):
            across = near[:, :2] @ y
            made["wall_m"] = [round(float(across.min()), 4), round(float(across.max()), 4)]
        return made

    def elements(self):
        stairs, made = {}, []
        for entity in self.wanted:
            if entity.id() not in self.shapes or is_a(entity, ("IfcSpace",)):
                continue
            kind, whole = kind_of(entity), stair_of(entity)
            if whole is not None and kind != "railing":
                stairs.setdefault(whole.id(), (whole, []))[1].append(entity)
            else:
                made.append((entity.id(), kind, entity, [entity]))
        made += [(i, "stairs", whole, parts) for i, (whole, parts) in stairs.items()]
        made.sort(key=lambda item: item[0])
        return [self.element(kind, entity, parts) for _, kind, entity, parts in made]

    def document(self):
        self.open()
        self.make_shapes()
        self.move_near()
        storeys = self.storey_index()
        spaces = [self.space(p) for p in self.wanted
                  if p.id() in self.shapes and is_a(p, ("IfcSpace",))]
        elements = self.elements()
        return {"format": 1, "schema": self.schema, "notes": self.notes, "storeys": storeys,
                "colours": [list(c) for c in self.colours],
                "spaces": [s for s in spaces if s is not None], "elements": elements}


def stair_of(entity):
    """The IfcStair that it is a part of, or None."""
    from ifcopenshell.util import element as util
    for _ in range(16):
        if entity is None or is_a(entity, ("IfcStair",)):
            return entity
        entity = util.get_aggregate(entity)
    return None


def rounded(vertices):
    return (vertices.round(4) + 0.0).ravel().tolist()


def largest(area):
    import shapely
    parts = [g for g in getattr(area, "geoms", [area]) if g.geom_type == "Polygon"]
    return max(parts, key=lambda g: g.area, default=shapely.Polygon())


def outline_of(vertices, faces):
    """Corners of the ground of a space, None where it has none."""
    import numpy
    import shapely
    corners = vertices[faces]
    normals = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    flat = abs(normals[:, 2]) > 0.7 * numpy.linalg.norm(normals, axis=1)
    low = corners[:, :, 2].mean(axis=1) < vertices[:, 2].min() + BOTTOM_M
    areas = []
    for chosen in (flat & low, flat):
        triangles = [shapely.Polygon(c[:, :2]) for c in corners[chosen]]
        triangles = [t for t in triangles if t.area > 1e-6]
        ground = shapely.unary_union([t.buffer(1e-3, join_style="mitre") for t in triangles])
        areas.append(largest(ground))
    # A stair's space may stand on its lowest tread only: then the next area counts.
    ground = areas[0] if areas[0].area > 0.5 * areas[1].area else areas[1]
    if ground.area < 0.05:
        return None
    ground = largest(shapely.Polygon(ground.exterior).buffer(-1e-3, join_style="mitre"))
    ground = largest(ground.simplify(0.01))
    if ground.is_empty:
        return None
    points = numpy.array(shapely.normalize(ground).exterior.coords)[:-1]
    return [[round(float(x), 4) + 0.0, round(float(y), 4) + 0.0] for x, y in points]


def main():
    try:
        import ifcopenshell  # noqa: F401
        import shapely  # noqa: F401
    except ImportError:
        return 3
    try:
        text = json.dumps(Building(sys.argv[1]).document(), allow_nan=False,
                          separators=(",", ":"))
    except Refused as refused:
        OUT.write(f"{refused}\n")
        OUT.flush()
        return 1
    except MemoryError:
        OUT.write("needs more memory than its reader may use; export single storeys\n")
        OUT.flush()
        return 1
    except Exception as error:  # the library raises any type on a damaged file
        what = " ".join(f"{type(error).__name__}: {error}".split())[:200]
        OUT.write(f"cannot be read by IfcOpenShell ({what}); export it again\n")
        OUT.flush()
        return 1
    OUT.write(text + "\n")
    OUT.flush()
    return 0


status = main()
os._exit(status)  # skips the library's slow shutdown
