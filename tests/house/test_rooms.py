"""tests.rooms_are_acyclic: the rooms keep the order of rooms.txt, and no two modules form a circle.

test_rooms.py ROOT [LIST]   checks the sources under ROOT against LIST (ROOT/tests/house/rooms.txt)
test_rooms.py --self-test   checks that each fault below is found in a made-up tree

A room is a folder STAGE/ROOM of sources. A module is a pair NAME.c and NAME.h, or one of them.
Faults, one line each, with the file and line of the include:
  order     a room includes a room that is not before it in the list
  never     a room reaches what the list forbids it, directly or through other headers
  circle    modules include each other in a circle
  private   a private header is included from another room
  place     a source lies outside a room, or in a room that the list lacks
  readme    a room has no README.md
  size      a room has fewer than 3 or more than 14 modules

One circle is allowed: a private header and its owner. A private header is a header without source,
named internal.h (its owner is the module named like the room) or NAME_internal.h (its owner: NAME).
It may include its owner; only its own room includes it.
"""
import os
import re
import sys
import tempfile

LEAST, MOST = 3, 14
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')


class Rooms:
    """The list: rooms in order, and pairs (folder, forbidden)."""

    def __init__(self, text):
        self.order, self.never = [], []
        for line in text.splitlines():
            words = line.split('#')[0].split()
            if len(words) == 1:
                self.order.append(words[0])
            elif len(words) > 2 and words[1] == 'never':
                self.never += [(words[0], word) for word in words[2:]]
            elif words:
                raise SystemExit(f'rooms.txt: not understood: {line}')
        self.level = {room: i for i, room in enumerate(self.order)}
        self.stages = sorted({room.split('/')[0] for room in self.order})


def read_tree(root, stages):
    """{path: [(line number, included path)]} of the C sources of all stages."""
    tree = {}
    for stage in stages:
        for folder, _, names in os.walk(os.path.join(root, stage)):
            for name in names:
                if name.endswith(('.c', '.h')):
                    full = os.path.join(folder, name)
                    with open(full, encoding='utf-8') as file:
                        found = [(i, INCLUDE.match(line)) for i, line in enumerate(file, 1)]
                    path = os.path.relpath(full, root).replace(os.sep, '/')
                    tree[path] = [(i, match.group(1)) for i, match in found if match]
    return tree


def room_of(path):
    return path.rsplit('/', 1)[0]


def module_of(path):
    return path.rsplit('.', 1)[0]


def is_within(path, folder):
    return path == folder or path.startswith(folder + '/')


def private_headers(tree):
    """{private header's module: owner's module}"""
    owners = {}
    for path in tree:
        module = module_of(path)
        name = module.rsplit('/', 1)[1]
        if not path.endswith('.h') or module + '.c' in tree:
            continue
        if name == 'internal':
            owners[module] = room_of(path) + '/' + room_of(path).rsplit('/', 1)[1]
        elif name.endswith('_internal'):
            owners[module] = module[:-len('_internal')]
    return owners


def check_places(root, tree, rooms):
    for path in sorted(tree):
        if room_of(path) not in rooms.level:
            yield f'place: {path}: {room_of(path)} is not a room of the list'
    for room in rooms.order:
        owners = private_headers(tree)
        modules = {module_of(path) for path in tree if room_of(path) == room} - set(owners)
        if not LEAST <= len(modules) <= MOST:
            yield f'size: {room} has {len(modules)} modules, must have {LEAST} to {MOST}'
        if not os.path.isfile(os.path.join(root, room, 'README.md')):
            yield f'readme: {room} has no README.md'


def check_order(tree, rooms):
    owners = private_headers(tree)
    for path, includes in sorted(tree.items()):
        room = room_of(path)
        for line, target in includes:
            place = f'{path}:{line}: includes {target}'
            if target.startswith('tests/'):
                yield f'order: {place}, a test'
            if target not in tree or room_of(target) == room:
                continue
            if module_of(target) in owners:
                yield f'private: {place}, private to {room_of(target)}'
            if rooms.level.get(room_of(target), -1) > rooms.level.get(room, len(rooms.level)):
                yield f'order: {place}, but {room_of(target)} is above {room}'


def forbidden(target, name):
    """Is the include target in the folder name, or a header of the library name?"""
    return is_within(target, name) or ('/' not in name and
                                       re.match(re.escape(name) + r'[a-z]*\.h$', target))


def check_never(tree, rooms):
    for folder, name in rooms.never:
        for start in sorted(path for path in tree if is_within(path, folder)):
            reached, waiting = {start: ''}, [start]
            while waiting:
                path = waiting.pop(0)
                for line, target in tree[path]:
                    chain = reached[path] + f'{path}:{line}: includes {target}; '
                    if forbidden(target, name):
                        # a longer chain through this folder is told where it begins
                        if path == start or not is_within(path, folder):
                            yield f'never: {chain}{folder} must not reach {name}'
                    elif target in tree and target not in reached:
                        reached[target] = chain
                        waiting.append(target)


def strong_components(edges):
    """Sets of nodes that reach each other, by two depth-first walks (Kosaraju, Sharir 1981)."""
    def walk(graph, start, seen):
        order, stack = [], [(start, iter(sorted(graph.get(start, ()))))]
        seen.add(start)
        while stack:
            node, rest = stack[-1]
            for target in rest:
                if target not in seen:
                    seen.add(target)
                    stack.append((target, iter(sorted(graph.get(target, ())))))
                    break
            else:
                stack.pop()
                order.append(node)
        return order

    finished, seen, reverse = [], set(), {}
    for node in sorted(edges):
        for target in edges[node]:
            reverse.setdefault(target, set()).add(node)
    for node in sorted(edges):
        if node not in seen:
            finished += walk(edges, node, seen)
    seen = set()
    for node in reversed(finished):
        if node not in seen:
            yield walk(reverse, node, seen)


def check_circles(tree):
    owners = private_headers(tree)
    edges, places = {}, {}
    for path, includes in sorted(tree.items()):
        module = module_of(path)
        edges.setdefault(module, set())
        for line, target in includes:
            other = module_of(target)
            if target in tree and other != module and owners.get(module) != other:
                edges[module].add(other)
                places.setdefault((module, other), f'{path}:{line}: includes {target}')
    for circle in strong_components(edges):
        if len(circle) > 1:
            inside = [place for (a, b), place in sorted(places.items())
                      if a in circle and b in circle]
            yield f'circle: {" ".join(sorted(circle))}' + ''.join(f'\n    {p}' for p in inside)


def check(root, rooms):
    tree = read_tree(root, rooms.stages)
    faults = list(check_places(root, tree, rooms))
    faults += check_order(tree, rooms)
    faults += check_never(tree, rooms)
    faults += check_circles(tree)
    return tree, faults


# A tree without faults, and changes of it that are one fault each.

GOOD_ROOMS = 'low/a\nlow/b\nhigh/c # on top\nhigh never secret petsc\nlow/b never low/a/y.h\n'
GOOD = {
    'low/a/x.c': '#include "low/a/x.h"\n', 'low/a/x.h': '#include <stdio.h>\n', 'low/a/y.h': '',
    'low/a/z.c': '', 'low/b/b.h': '', 'low/b/u.c': '#include "low/a/x.h"\n',
    'low/b/b.c': '#include "low/b/internal.h"\n', 'low/b/internal.h': '#include "low/b/b.h"\n',
    'low/b/v.c': '#include "low/b/internal.h"\n#include "low/b/b.h"\n',
    'high/c/x.c': '#include "high/c/x.h"\n#include "low/b/b.h"\n', 'high/c/x.h': '',
    'high/c/y.c': '', 'high/c/z.c': '',
    'low/a/README.md': '', 'low/b/README.md': '', 'high/c/README.md': '',
}
FAULTS = [  # name, word and file that the message must hold, files changed (None: deleted)
    ('a higher room', 'order', 'low/a/z.c:2', {'low/a/z.c': '\n#include "high/c/x.h"\n'}),
    ('a test', 'order', 'high/c/y.c:1', {'high/c/y.c': '#include "tests/support/check.h"\n'}),
    ('PETSc', 'never', 'high/c/y.c:1', {'high/c/y.c': '#include <petscmat.h>\n'}),
    ('PETSc through a header', 'never', 'high/c/x.c:2', {'low/b/b.h': '#include <petsc.h>\n'}),
    ('a forbidden header', 'never', 'low/b/u.c', {'low/a/x.h': '#include "low/a/y.h"\n'}),
    ('circle of two', 'circle', 'low/a/x low/a/z',
     {'low/a/x.c': '#include "low/a/z.h"\n', 'low/a/z.h': '#include "low/a/x.h"\n'}),
    ('circle of three', 'circle', 'high/c/x high/c/y high/c/z',
     {'high/c/x.c': '#include "high/c/y.h"\n', 'high/c/y.h': '#include "high/c/z.h"\n',
      'high/c/z.h': '#include "high/c/x.h"\n'}),
    ('circle through a private header', 'circle', 'low/b/internal low/b/v',
     {'low/b/internal.h': '#include "low/b/v.h"\n', 'low/b/v.h': ''}),
    ('private header of another room', 'private', 'high/c/y.c:1',
     {'high/c/y.c': '#include "low/b/internal.h"\n'}),
    ('source in a top folder', 'place', 'low/stray.c', {'low/stray.c': ''}),
    ('source in a room not listed', 'place', 'low/d/x.c', {'low/d/x.c': ''}),
    ('no README.md', 'readme', 'low/b', {'low/b/README.md': None}),
    ('too few modules', 'size', 'low/a', {'low/a/z.c': None}),
    ('too many modules', 'size', 'high/c', {f'high/c/more{i}.c': '' for i in range(MOST)}),
]


def write_tree(root, files):
    for path, text in files.items():
        if text is not None:
            full = os.path.join(root, path)
            os.makedirs(os.path.dirname(full), exist_ok=True)
            with open(full, 'w', encoding='utf-8') as file:
                file.write(text)


def self_test():
    rooms, failed = Rooms(GOOD_ROOMS), 0
    for name, word, part, change in [('no fault', '', '', {})] + FAULTS:
        with tempfile.TemporaryDirectory() as root:
            write_tree(root, {**GOOD, **change})
            found = check(root, rooms)[1]
        kinds = {fault.split(':')[0] for fault in found}
        good = (kinds == {word} and any(part in fault for fault in found)) if word else not found
        failed += not good
        print(f'{"ok" if good else "FAILED"}: {name}: {"; ".join(found) or "nothing found"}')
    return failed != 0


def main(arguments):
    if arguments == ['--self-test']:
        return self_test()
    root = arguments[0]
    path = arguments[1] if len(arguments) > 1 else os.path.join(root, 'tests/house/rooms.txt')
    with open(path, encoding='utf-8') as file:
        rooms = Rooms(file.read())
    tree, faults = check(root, rooms)
    for fault in faults:
        print(fault)
    n_includes = sum(1 for includes in tree.values() for _, target in includes if target in tree)
    print(f'{len(rooms.order)} rooms, {len({module_of(path) for path in tree})} modules, '
          f'{n_includes} includes: {len(faults)} faults')
    return len(faults) != 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
