#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks includes (docs/architecture.md): rooms one way, third-party headers in adapters.

    scripts/check_includes.py [ROOT]

Prints one line for each include or CMake DEPS entry that is not allowed; exit status 1 if any.
"""
import fnmatch
import pathlib
import re
import sys

_LEFT = {"core", "geometry", "perception", "memory", "planner"}
_AGENT = _LEFT | {"objects", "scenegraph", "language", "policy", "trace", "agent"}

# Rooms that each room may include besides itself. In `evaluation` the agent meets the simulator.
ROOMS = {
    "core": set(),
    "geometry": {"core"},
    "perception": {"core"},
    "inference": {"core", "perception"},
    "memory": {"core", "geometry"},
    "objects": {"core", "geometry", "memory"},
    "planner": {"core", "geometry"},
    "policy": _LEFT,
    "localization": {"core", "geometry", "planner", "policy"},
    "trace": {"core", "geometry", "policy"},
    "watch": {"core", "geometry", "trace"},
    "agent": _AGENT - {"agent"},
    "serve": {"core", "perception", "localization", "agent"},
    "sim": {"core", "geometry", "perception"},
    "recordings": {"core", "sim", "trace"},
    "world": {"core", "sim"},
    "homes": {"core", "sim", "world"},
    "store": {"core", "geometry", "memory", "objects"},
    "scenegraph": {"core", "geometry", "memory", "objects"},
    "language": {"core", "geometry", "memory", "objects", "localization", "scenegraph"},
    "evaluation": _AGENT | {"localization", "inference", "serve", "sim", "world", "homes", "store"},
}

# Rooms with folders: folders of the same room that each folder may include besides itself.
FOLDERS = {
    "sim": {
        "scene": set(),
        "render": {"scene"},
        "navmesh": {"scene", "render"},
        "sensing": {"scene", "render", "navmesh"},
    },
    "evaluation": {
        "files": set(),
        "records": {"files"},
        "settings": {"records"},
        "episodes": {"files", "records"},
        "scoring": {"episodes", "files", "records", "settings"},
        "generation": {"episodes", "records", "scoring", "settings"},
        "running": {"episodes", "files", "records", "scoring", "settings"},
        "lifelong": {"episodes", "files", "records", "running", "scoring", "settings"},
        "trials": {"episodes", "generation", "records", "running", "scoring", "settings"},
        "reporting": {"records", "scoring", "settings"},
    },
    "world": {
        "mesh": set(),
        "scene": set(),
        "change": {"scene"},
        "models": {"mesh"},
        "plan": {"mesh"},
        "stairs": {"mesh", "plan"},
        "layout": {"mesh", "plan", "stairs"},
        "surface": {"mesh", "plan"},
        "furniture": {"mesh", "models", "plan", "surface"},
        "shell": {"mesh", "plan", "surface"},
        "house": {"furniture", "layout", "mesh", "plan", "scene", "shell", "stairs", "surface"},
    },
}

# Third-party headers that any file may include: common vocabulary of the project.
COMMON = re.compile(r"^(Eigen/|fmt/|gtest/|gmock/|benchmark/)")

# Adapters: library -> (its headers, patterns of files that may include them). Tests are exempt. A
# library appears in as few files as possible of each room that needs it.
ADAPTERS = {
    "tl-expected": (r"^tl/", ["crossnav/core/result.h"]),
    "Embree": (r"^embree[34]/", ["crossnav/sim/render/embree_shim.h"]),
    "oneTBB": (r"^tbb/", ["crossnav/sim/render/embree_shim.h"]),
    "meshoptimizer": (r"^meshoptimizer", ["crossnav/world/mesh/simplify.cpp"]),
    "tinygltf": (r"^tiny_gltf", ["crossnav/sim/scene/gltf_accessor.h"]),
    "Recast and Detour": (r"^recastnavigation/", ["crossnav/sim/navmesh/*"]),
    "Highway": (r"^hwy/", ["crossnav/memory/row_kernels.cpp", "crossnav/geometry/end_rows.cpp",
                            "crossnav/geometry/*_lanes.cpp",
                            "crossnav/geometry/grazing_surface_simd.cpp", "crossnav/sim/render/*_lanes.cpp"]),
    "libjpeg": (r"^jpeglib", ["crossnav/sim/scene/image_codec.cpp", "crossnav/trace/preview.cpp"]),
    "Basis Universal": (r"^transcoder/", ["crossnav/sim/scene/basis_image.cpp"]),
    "libpng": (r"^png", ["crossnav/core/png_image.cpp"]),
    "xxHash": (r"^xxhash", ["crossnav/sim/scene/scene.cpp", "crossnav/sim/navmesh/*.cpp",
                            "crossnav/store/*.cpp", "crossnav/world/furniture/furniture_pack.cpp",
                            "crossnav/inference/frame_input.cpp"]),
    "Protobuf": (r"^google/protobuf/", ["crossnav/serve/messages.cpp"]),
    "libevent": (r"^event2/", ["crossnav/watch/event_server.cpp"]),
    "OpenVINO": (r"^openvino/", ["crossnav/inference/openvino_backend.cpp"]),
    "ONNX Runtime": (r"^onnxruntime", ["crossnav/inference/onnxruntime_backend.cpp"]),
    "zlib": (r"^zlib", ["crossnav/evaluation/files/gzip_file.cpp", "crossnav/trace/mcap_writer.cpp",
                        "crossnav/trace/replay_page.cpp",
                        "crossnav/world/furniture/furniture_pack.cpp"]),
    "libzip": (r"^zip\.h", ["crossnav/world/models/zip_reader.cpp"]),
    "zstd": (r"^zstd", ["crossnav/trace/mcap_*.cpp", "crossnav/store/*.cpp"]),
    "SQLite": (r"^sqlite3", ["crossnav/store/*"]),
    "simdjson": (r"^simdjson", ["crossnav/evaluation/episodes/episode_reader.cpp",
                                "crossnav/evaluation/episodes/picture_json.h",
                                "crossnav/trace/json_reader.h"]),
    "nlohmann-json": (r"^nlohmann/", ["crossnav/evaluation/reporting/comparison.cpp",
                                      "crossnav/evaluation/episodes/episode_writer.cpp",
                                      "crossnav/evaluation/lifelong/visit_report.cpp",
                                      "crossnav/evaluation/reporting/gaps_text.cpp",
                                      "crossnav/evaluation/reporting/metrics_report.cpp",
                                      "crossnav/evaluation/reporting/report_figures.cpp",
                                      "crossnav/evaluation/records/result_json.cpp",
                                      "crossnav/evaluation/records/result_line.h",
                                      "crossnav/evaluation/episodes/suite.cpp",
                                      "crossnav/evaluation/scoring/viewpoint_cache.cpp",
                                      "crossnav/homes/building_file.cpp",
                                      "crossnav/homes/objects_file.cpp",
                                      "crossnav/world/change/changes.cpp",
                                      "crossnav/world/furniture/furniture_pack.cpp",
                                      "crossnav/world/scene/glb_writer.cpp",
                                      "crossnav/world/house/house_file.cpp", "apps/crossnav/*"]),
    "pugixml": (r"^pugixml", ["crossnav/homes/home_xml.cpp"]),
    "Assimp": (r"^assimp/", ["crossnav/homes/assimp_reader.cpp"]),
    "toml++": (r"^toml", ["crossnav/evaluation/settings/config_file.cpp",
                           "crossnav/inference/model_card.cpp"]),
    "CLI11": (r"^CLI/", ["apps/crossnav/*"]),
    "nanobind": (r"^nanobind/", ["python/src/*"]),
}

INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"([^"]+)"|<([^>]+)>)')
# Headers of the language and of the system: no slash and no dot, or C and POSIX names.
SYSTEM = re.compile(r"^([a-z_]+|(std|string|errno|stdio|stdlib|stdint|math|time|signal|fcntl|dlfcn|"
                    r"unistd|malloc|cxxabi|execinfo|cpuid|immintrin|sched|pthread|poll|termios)\.h|"
                    r"(sys|linux|arpa|netinet|bits)/.*)$")


def included(path):
    """Yields (line number, name, is it ours or generated) of every include of a file."""
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if match:
            yield number, match.group(1) or match.group(2), bool(match.group(1))


def check_room_include(room, name):
    """The problem with including one of our headers from a room, or None."""
    parts = name.split("/")
    if parts[0] == "apps":
        return "a room includes the program"
    other = parts[1] if len(parts) > 2 else None
    if other not in ROOMS:
        return f"no such room: {name}"
    if other != room and other not in ROOMS[room]:
        return f"{room} may not include {other} ({name})"
    return None


def check_folder(room, relative):
    """The problem with the place of a room's file, or None."""
    parts = relative.split("/")
    if room in FOLDERS and (len(parts) < 4 or parts[2] not in FOLDERS[room]):
        return f"{relative}: {room} has the folders {', '.join(sorted(FOLDERS[room]))}"
    return None


def check_folder_include(relative, name):
    """The problem with including one of our headers across the folders of a room, or None."""
    own, other = relative.split("/"), name.split("/")
    if own[1] != other[1] or own[1] not in FOLDERS or own[2] == other[2]:
        return None
    if other[2] not in FOLDERS[own[1]].get(own[2], set()):
        return f"{own[1]}/{own[2]} may not include {own[1]}/{other[2]} ({name})"
    return None


def check_third_party(relative, name):
    """The problem with a third-party include, or None."""
    if COMMON.match(name) or SYSTEM.match(name):
        return None
    for library, (headers, files) in ADAPTERS.items():
        if re.match(headers, name):
            if any(fnmatch.fnmatchcase(relative, pattern) for pattern in files):
                return None
            return f"{library} belongs behind {', '.join(files)}, not here (<{name}>)"
    return f"unknown third-party header <{name}>: give it an adapter in scripts/check_includes.py"


def check_cmake_deps(path, room):
    """Problems with the DEPS of a room's CMakeLists.txt."""
    text = re.sub(r"#.*", "", path.read_text(encoding="utf-8"))
    for call in re.findall(r"crossnav_library\(([^)]*)\)", text):
        words = call.split()
        listing = False
        for word in words[1:]:
            if word in ("SOURCES", "DEPS", "PUBLIC", "PRIVATE"):
                listing = word == "DEPS"
            elif listing and word not in ROOMS[room]:
                yield f"{room} may not link {word}"
        for target in re.findall(r"crossnav::(\w+)", call):
            if target not in ROOMS[room]:
                yield f"{room} may not link {target}"


def check_file(root, path, room):
    """Problems of one file; `room` is None for the program, which may include every room."""
    relative = path.relative_to(root).as_posix()
    if misplaced := check_folder(room, relative):
        yield misplaced
    for number, name, is_ours in included(path):
        if not is_ours:
            problem = check_third_party(relative, name)
        elif room and name.startswith(("crossnav/", "apps/")):
            problem = check_room_include(room, name) or check_folder_include(relative, name)
        else:
            problem = None  # a generated header
        if problem:
            yield f"{relative}:{number}: {problem}"


def check(root):
    """All problems under `root`, as 'file:line: text'."""
    problems = []
    for folder in sorted(p for p in (root / "crossnav").iterdir() if p.is_dir()):
        room = folder.name
        if room not in ROOMS:
            problems.append(f"crossnav/{room}: a room that scripts/check_includes.py does not know")
            continue
        for path in sorted(p for p in folder.rglob("*") if p.suffix in (".h", ".cpp")):
            problems += check_file(root, path, room)
        lists = folder / "CMakeLists.txt"
        if lists.exists():
            problems += [f"crossnav/{room}/CMakeLists.txt: {p}"
                         for p in check_cmake_deps(lists, room)]
    for folder in ("apps", "python"):
        for path in sorted(p for p in (root / folder).rglob("*") if p.suffix in (".h", ".cpp")):
            problems += check_file(root, path, None)
    return problems


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else __file__).resolve()
    if root.is_file():
        root = root.parent.parent
    problems = check(root)
    print("\n".join(problems) if problems else "includes: all as docs/architecture.md says")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
