"""What the tests of the project's structure share: its C++ files, what each includes, and the units they form."""
import pathlib
import posixpath
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
CPP = (".h", ".hpp", ".cpp", ".def")


def project_files():
    """Every file of the checkout by its path from the root, without what is built, drafted or hidden."""
    for top in sorted(ROOT.iterdir()):
        if top.name == ".ci" or not re.match(r"\.|build|out$", top.name):
            for path in sorted([top] if top.is_file() else top.rglob("*")):
                if path.is_file() and "__pycache__" not in path.parts:
                    yield path.relative_to(ROOT)


def folder_of(name):
    return name.rpartition("/")[0]


def unit_of(name):
    """A header and the source of the same name are one unit."""
    return name.rpartition(".")[0]


class Sources:
    """C++ files by name. `includes[name]` lists (line, header); headers of the project stand by their full names.

    `unknown` lists (name, line, header) of quoted includes that name no file of the project.
    """

    def __init__(self, texts):
        self.texts = texts
        self.unknown = []
        self.includes = {name: list(self._read_includes(name)) for name in texts}

    def _read_includes(self, name):
        for number, line in enumerate(self.texts[name].splitlines(), 1):
            match = re.match(r'\s*#\s*include\s*(["<])([^">]+)[">]', line)
            if match:
                header = self._full_name(name, match[2]) if match[1] == '"' else match[2]
                if match[1] == '"' and header not in self.texts:
                    self.unknown.append((name, number, header))
                yield number, header

    def _full_name(self, name, header):
        """A compiler looks beside the file first, then from the root."""
        beside = posixpath.normpath(posixpath.join(folder_of(name), header))
        return beside if beside in self.texts else header

    def own_includes(self, name):
        """Headers of the project that the file includes."""
        return [header for _, header in self.includes[name] if header in self.texts]

    def includers(self):
        """For each file the files that include it."""
        users = {name: [] for name in self.texts}
        for name in self.texts:
            for header in self.own_includes(name):
                users[header].append(name)
        return users

    def units(self):
        """For each unit the other units that it includes."""
        graph = {unit_of(name): set() for name in self.texts}
        for name in self.texts:
            graph[unit_of(name)] |= {unit_of(header) for header in self.own_includes(name)} - {unit_of(name)}
        return graph


def read_sources():
    names = [path.as_posix() for path in project_files() if path.suffix in CPP]
    return Sources({name: (ROOT / name).read_text() for name in names})


def reached_from(start, next_of):
    """Everything that can be reached from `start` in one step or more."""
    reached, waiting = set(), [start]
    while waiting:
        for node in next_of(waiting.pop()):
            if node not in reached:
                reached.add(node)
                waiting.append(node)
    return reached
