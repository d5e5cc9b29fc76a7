# Relinks programs of a built tree with a few sources changed, without touching the tree.
# SPDX-License-Identifier: MIT
"""A Relinker reads a tree that CMake configured for Ninja and that is built. It compiles the objects that depend on the changed
sources, and links a program with them in place of the tree's objects. All that it writes goes into a scratch folder.

Changed sources lie in an overlay: a folder that mirrors the source tree and comes first in the include path. A source of a unity
group is reached through a copy of the group's file. The compiler reads changed headers from the overlay, too.
"""
import functools
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess


class RelinkError(Exception):
    """What is wrong with the tree, the change or the build, in words for the user."""


def run(command, where, shell=False):
    done = subprocess.run(command, cwd=where, shell=shell, capture_output=True, text=True, errors="replace")
    return done.returncode, done.stdout, done.stderr


def time_of(path):
    """When a file was changed; None: it is not there."""
    try:
        return os.stat(path).st_mtime_ns
    except OSError:
        return None


class Relinker:
    def __init__(self, build, scratch):
        self.build = pathlib.Path(build).resolve()
        self.scratch = pathlib.Path(scratch).resolve()
        if not (self.build / "build.ninja").exists():
            raise RelinkError(f"{self.build}: there is no build.ninja; configure and build the tree first")
        cache = (self.build / "CMakeCache.txt").read_text(encoding="utf-8", errors="replace")
        home = re.search(r"^CMAKE_HOME_DIRECTORY:INTERNAL=(.*)$", cache, re.MULTILINE)
        if not home:
            raise RelinkError(f"{self.build}/CMakeCache.txt: it does not name its sources")
        self.root = pathlib.Path(home[1]).resolve()
        self.compiles = self._read_compile_commands()
        self._reads = None
        self._links = {}

    # What the tree says.

    def _read_compile_commands(self):
        path = self.build / "compile_commands.json"
        if not path.exists():
            raise RelinkError(f"{path}: it is missing; configure with CMAKE_EXPORT_COMPILE_COMMANDS=ON")
        compiles = {}
        for entry in json.loads(path.read_text(encoding="utf-8")):
            words = shlex.split(entry["command"])
            compiles[words[words.index("-o") + 1]] = (words, pathlib.Path(entry["file"]))
        return compiles

    def ninja(self, *words):
        # -n: these questions must not write ninja's logs.
        code, out, err = run(["ninja", "-n", "-C", str(self.build), *words], self.build)
        if code != 0:
            raise RelinkError(f"ninja {' '.join(words)}: {(err or out).strip()}")
        return out

    def check_built(self, programs):
        """Raises an error unless the programs are built and none of their sources is newer.

        Ninja's dry run does not tell: where CMake looks for new files in folders it ends before it comes to the programs.
        """
        for program in programs:
            objects = self.objects_in(program)
            reads = self.reads
            made = time_of(self.build / self.output_of(program))
            for name in objects & set(reads):
                time = time_of(self.build / name)
                if time is None or made is None or time > made or any((time_of(path) or 0) > time for path in reads[name]):
                    raise RelinkError(f"{program}: not built, or older than its sources; run: ninja -C {self.build} {program}")
            if made is None or not objects & set(reads):
                raise RelinkError(f"{program}: not built; run: ninja -C {self.build} {program}")

    @property
    def reads(self):
        """The files that the last compilation of each object read."""
        if self._reads is None:
            self._reads, name = {}, None
            for line in self.ninja("-t", "deps").splitlines():
                if line.startswith(" "):
                    self._reads[name].append(self._absolute(line.strip()))
                elif line:
                    name = line.split(":", 1)[0]
                    self._reads[name] = []
        return self._reads

    @functools.cache
    def _absolute(self, path):
        return str((self.build / path).resolve())

    def users_of(self, source):
        """The objects whose last compilation read a source or header, by its path below the root."""
        path = self._absolute(str(self.root / source))
        return sorted(name for name, paths in self.reads.items() if path in paths and name in self.compiles)

    def _commands_of(self, program):
        """The words of the link command of a program, and the objects of each archive below it."""
        if program in self._links:
            return self._links[program]
        archives, link = {}, None
        for line in self.ninja("-t", "commands", program).splitlines():
            for part in line.split(" && "):
                words = shlex.split(part) if " qc " in part or " -o " in part else []
                if "qc" in words:
                    at = words.index("qc")
                    archives[words[at + 1]] = words[at + 2:]
                elif "-o" in words and "-c" not in words:
                    link = words
        if link is None:
            raise RelinkError(f"{program}: the build has no link command for it")
        self._links[program] = link, archives
        return link, archives

    def output_of(self, program):
        link, _ = self._commands_of(program)
        return link[link.index("-o") + 1]

    def objects_in(self, program):
        """The objects of the tree that a program's own link line names, by themselves or within archives."""
        link, archives = self._commands_of(program)
        objects = {word for word in link if word.endswith(".o")}
        for word in link:
            objects.update(archives.get(word, ()))
        return objects

    # What is made.

    def compile(self, changes, name, programs, defines=(), compiled=None):
        """Compiles what the programs have of some changed sources.

        @param changes  text by path below the root
        @param name     of a folder in the scratch folder; an older one of that name is replaced
        @param compiled  those of the sources whose readers are compiled; default: all
        @returns a dictionary from the tree's objects to the new ones
        """
        folder = self.scratch / name
        shutil.rmtree(folder, ignore_errors=True)
        overlay = folder / "sources"
        for source, text in changes.items():
            path = overlay / source
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        wanted = set().union(*(self.objects_in(program) for program in programs))
        users = {source: wanted.intersection(self.users_of(source)) for source in compiled or changes}
        for source, objects in users.items():
            if not objects:
                raise RelinkError(f"{source}: no object of {' '.join(programs)} reads it")
        made = {}
        for number, old in enumerate(sorted(set().union(*users.values()))):
            made[old] = self._compile_one(old, changes, overlay, folder / f"{number}.o", defines)
        return made

    def _compile_one(self, old, changes, overlay, new, defines):
        words, file = self.compiles[old]
        words = list(words)
        own = {str((self.root / source).resolve()): overlay / source for source in changes}
        source = own.get(str(file.resolve()), file)
        homes = [file.parent] if source != file else []
        if source == file:
            text = file.read_text(encoding="utf-8", errors="replace")
            group = re.sub(r'^(\s*#\s*include\s*)"([^"\n]+)"', lambda m: self._moved(m, own, homes), text, flags=re.MULTILINE)
            if group != text:
                source = new.with_suffix(".group.cpp")
                source.write_text(group, encoding="utf-8")
        words[words.index("-o") + 1] = str(new)
        words[words.index("-c") + 1] = str(source)
        # Before all other folders of headers; quoted names that are relative to a moved source stay where they were.
        first = next((i for i, word in enumerate(words) if word.startswith(("-I", "-isystem"))), 1)
        words[first:first] = [f"-I{overlay}", *(f"-iquote{home}" for home in homes), *(f"-D{name}" for name in defines)]
        code, out, err = run(words, self.build)
        if code != 0:
            raise RelinkError(f"{old}: it does not compile with the change:\n{(err or out).strip()}")
        return new

    def _moved(self, match, own, homes):
        path = pathlib.Path(match[2])
        to = own.get(str(path.resolve())) if path.is_absolute() else None
        if to is None:
            return match[0]
        homes.append(path.parent)
        return f'{match[1]}"{to}"'

    def link(self, program, objects, out):
        """Links a program with some of its objects replaced.

        A new object that replaces one within an archive stands directly before the archive. It defines what the archive's own
        defines, so that the linker never takes that one in.

        @returns false if the program has none of the objects
        """
        link, archives = self._commands_of(program)
        words, replaced = [], 0
        left = dict(objects)
        for i, word in enumerate(link):
            if link[i - 1] == "-o":
                word = str(out)
            elif word in left:
                word = str(left.pop(word))
                replaced += 1
            elif word in archives:
                inside = [old for old in archives[word] if old in left]
                words += [str(left.pop(old)) for old in inside]
                replaced += len(inside)
            words.append(word)
        if not replaced:
            return False
        out.parent.mkdir(parents=True, exist_ok=True)
        code, said, err = run(words, self.build)
        if code != 0:
            raise RelinkError(f"{program}: it does not link with the change:\n{(err or said).strip()}")
        return True


def replace_once(text, old, new, where):
    """Replaces a text that must occur exactly once."""
    count = text.count(old)
    if count != 1:
        raise RelinkError(f"{where}: the text to replace occurs {count} times, not once: {old.strip().splitlines()[0]!r}")
    return text.replace(old, new)
