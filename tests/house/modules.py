# SPDX-License-Identifier: Apache-2.0
"""The table of modules in docs/ARCHITECTURE.md, and what of a source tree breaks it."""
import pathlib
import re
from dataclasses import dataclass, field

# How each library that a table may name is included.
LIBRARY_HEADERS = {
    "TBB": r"(tbb|oneapi)/",
    "spdlog": r"spdlog/",
    "fmt": r"fmt/",
    "xxHash": r"xxh",
    "dlopen": r"dlfcn\.h",
    "Imath": r"Imath/",
    "OpenImageIO": r"OpenImageIO/",
    "OpenEXR": r"(OpenEXR/|Imf|Iex|IlmThread)",
    "OpenSubdiv": r"opensubdiv/",
    "tinyobjloader": r"tiny_obj_loader",
    "yaml-cpp": r"yaml-cpp/",
    "liburcu": r"urcu",
    "Embree": r"embree[0-9]/",
    "Highway": r"hwy/",
    "CLI11": r"CLI/",
    "JSON": r"nlohmann/",
    "Boost": r"boost/",
    "pybind11": r"pybind11/",
    "CPython": r"Python\.h",
    "libpng": r"png\.h",
    "zlib": r"zlib\.h",
}
# Anything else in angle brackets is the C++ library (no dot, no slash), the C library or the system.
SYSTEM_HEADER = re.compile(r"([a-z_0-9]+|(sys(/platform)?|linux|arpa|netinet)/[a-z0-9]+\.h|[a-z]+\.h)$")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


@dataclass
class Module:
    name: str
    level: int
    may_include: set = field(default_factory=set)
    libraries: dict = field(default_factory=dict)  # name -> folder, the module itself or one below it


def table_rows(text, heading):
    """Cells of the first table below `heading`, without its two head lines."""
    lines = text[text.index(heading):].splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith("|"))
    rows = []
    for line in lines[start + 2:]:
        if not line.startswith("|"):
            break
        rows.append([cell.strip() for cell in line.strip().strip("|").split("|")])
    return rows


def read_modules(text):
    modules = {}
    for level, folder, _, may_include, libraries in table_rows(text, "## Modules"):
        module = Module(re.fullmatch(r"`([a-z]+(?:/[a-z]+)?)/`", folder).group(1), int(level))
        module.may_include = may_include.split() if may_include not in ("–", "all") else may_include
        for entry in libraries.split(",") if libraries != "–" else []:
            name, _, below = entry.strip().partition(" in ")
            module.libraries[name] = f"{module.name}/{below.strip('`/')}" if below else module.name
        modules[module.name] = module
    for module in modules.values():
        if module.may_include == "all":
            module.may_include = modules.keys() - {module.name}
        module.may_include = set(module.may_include) - {"–"}
    return modules


def module_of(path, modules):
    """Name of the module that a path belongs to; a folder of a module can be a module of its own, with its own level."""
    folders = path.split("/")[:-1]
    return next((name for count in range(len(folders), 0, -1) if (name := "/".join(folders[:count])) in modules),
                path.split("/")[0])


def read_shared_libraries(text):
    """Libraries of several modules -> the modules that may include them."""
    modules = read_modules(text).keys()
    return {name: set(modules if where == "all" else where.split())
            for name, where in table_rows(text, "### Shared libraries")}


def read_inner_layers(text):
    """Returns, in the order of the table, each folder of a module with the folders of the same module that it may
    include. The folder "." means the files that lie in no folder of the module."""
    if "### Inner layers" not in text:
        return {}
    return {re.fullmatch(r"`([a-z]+/[a-z]+)/`", folder).group(1): may_include.split() if may_include != "–" else []
            for folder, _, may_include in table_rows(text, "### Inner layers")}


def inner_violations(root, text):
    """One line for each include between two folders of a module that the table of inner layers does not allow."""
    layers, modules = read_inner_layers(text), read_modules(text)
    order = list(layers)
    found = []
    for folder, may_include in layers.items():
        module = folder.split("/")[0]
        for other in set(may_include) - {"."}:
            if f"{module}/{other}" not in order[:order.index(folder)]:
                found.append(f"the table lets {folder} include {other}, which is no folder above it")
    layered_modules = {folder.split("/")[0] for folder in layers}
    for module in sorted(layered_modules):
        for path in sorted((root / module).rglob("*")):
            if path.suffix not in (".h", ".cpp", ".inl"):
                continue
            inside = path.relative_to(root).as_posix()
            own = "/".join(inside.split("/")[:2])
            if inside.count("/") == 1 or module_of(inside, modules) != module:  # in the module itself, or in another
                continue
            if own not in layers:
                found.append(f"{inside}: {own} is not in the table of inner layers")
                continue
            for number, line in enumerate(path.read_text().splitlines(), 1):
                match = INCLUDE.match(line)
                if not match or match.group(1) != '"' or not match.group(2).startswith(module + "/"):
                    continue
                parts = match.group(2).split("/")
                other = parts[1] if len(parts) > 2 else "."
                if f"{module}/{other}" != own and other not in layers[own]:
                    found.append(f"{inside}:{number}: {own} may not include {match.group(2)}")
    return found


def library_of(header):
    return next((name for name, pattern in LIBRARY_HEADERS.items() if re.match(pattern, header)), None)


def violations(root, text):
    """One line for each include below `root` that the tables in `text` do not allow."""
    modules, shared = read_modules(text), read_shared_libraries(text)
    owners = {name: folder for module in modules.values() for name, folder in module.libraries.items()}
    found = [f"the tables name {name}, which LIBRARY_HEADERS does not know"
             for name in owners.keys() | shared.keys() if name not in LIBRARY_HEADERS]
    found += [f"the table lets {module.name} include {other}, which is no module below it"
              for module in modules.values() for other in sorted(module.may_include)
              if other not in modules or modules[other].level >= module.level]

    for module in modules.values():
        for path in sorted((root / module.name).rglob("*")):
            if path.suffix not in (".h", ".cpp", ".inl"):
                continue
            inside = path.relative_to(root).as_posix()
            if module_of(inside, modules) != module.name:
                continue
            for number, line in enumerate(path.read_text().splitlines(), 1):
                match = INCLUDE.match(line)
                if not match:
                    continue
                quoted, header = match.group(1) == '"', match.group(2)
                if quoted:
                    other = module_of(header, modules)
                    allowed = "/" in header and (other == module.name or other in module.may_include)
                else:
                    library = library_of(header)
                    if library is None:
                        allowed = SYSTEM_HEADER.match(header)
                    elif library in shared:
                        allowed = module.name in shared[library]
                    else:
                        allowed = inside.startswith(owners.get(library, "nowhere") + "/")
                if not allowed:
                    found.append(f"{inside}:{number}: {module.name} may not include {header}")
    return found + inner_violations(root, text)


def source_root():
    return pathlib.Path(__file__).resolve().parents[2]
