"""cases.field.field: the moving blade against sums of its own, VTK, and the rules of glTF.

Usage: test_field.py BIN, with the programs in BIN. Exit code 77: h5py is missing.
"""
import csv
import json
import os
import struct
import sys
import tempfile

try:
    import h5py
    import numpy as np
except ImportError:
    sys.exit(77)

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../support'))
import programs
from programs import write

BIN = os.path.abspath(sys.argv[1])
BLADES, ORDER = 7, 2

SHAPE = """    root: {length: 50 mm, width: 26 mm, height: 14 mm}
    sections:
      - {radius: 300 mm, chord: 42 mm, thickness: 6.5 mm, camber: 7 mm, twist: -12 deg}
      - {radius: 460 mm, chord: 35 mm, thickness: 3.2 mm, camber: 3 mm, twist: -38 deg}
    shroud: {length: 36 mm, thickness: 6 mm, contact: 18 mm}
"""
TOUCHED = """probe: {tip: [0 mm, 0 mm, 466 mm]}
contact: {to: neighbour, psi: 30 deg, mu: 0.3, ku: 1 MN/m, kv: 1.5 MN/m, n0: 60 N}
gauge: {g1: {at: [-18 mm, 3 mm, 380 mm], direction: [0.2, 0, 1]}}
"""
CASE = f"""name: blade
mesh:
  blade:
{SHAPE}    size: 14 mm
rotor: {{blades: 60, axis: x, speed: 1500 rpm}}
material: {{E: 205 GPa, nu: 0.3, rho: 7850}}
modal: {{modes: 6, damping: 0.003}}
excitation: {{engine_order: 56, pressure: 2 kPa}}
{TOUCHED}mhb: {{frequency: [230 Hz, 330 Hz], harmonics: 3}}
"""
OWN = f"""name: own
modal: {{file: own.modal.h5}}
rotor: {{blades: {BLADES}}}
excitation: {{engine_order: {ORDER}}}
contact: {{to: neighbour, psi: 30 deg, mu: 0.3, ku: 1 MN/m, kv: 1.5 MN/m, n0: 60 N}}
mhb: {{frequency: [230 Hz, 330 Hz], harmonics: 3}}
"""


# of 60 sectors; harmonics 1 to 3 run backwards at nodal diameters 4, 8, 12 with engine order 56
DISC = f"""name: disc
mesh:
  blade:
    disc: {{bore: 150 mm, web: 15 mm, rim: 25 mm}}
    elements: tet10
{SHAPE}    size: 20 mm
rotor: {{blades: 60, axis: x, speed: 1500 rpm}}
material: {{E: 205 GPa, nu: 0.3, rho: 7850, fatigue: {{endurance: 300 MPa, ultimate: 900 MPa}}}}
modal: {{modes: 8, damping: 0.003}}
excitation: {{engine_order: 56, pressure: 2 kPa, harmonics: {{1: [1, 0 deg], 2: [0.5, 40 deg]}}}}
{TOUCHED}mhb: {{frequency: [150 Hz, 330 Hz], harmonics: 3}}
"""


def run(*words, code=0):
    return programs.run(os.path.join(BIN, words[0]), *words[1:], code=code)


def check(what, error, bound):
    print(f'{what}: {error:.1e}, bound {bound:.0e}')
    assert error <= bound, what


def largest(a):
    return np.abs(a).max()


def refused(words, text):
    told = run(*words, code=2)
    assert text in told, told


class Point:
    """Harmonics of a kept point at every node, summed here."""

    def __init__(self, name, branch, point):
        modal, response = h5py.File(f'{name}.modal.h5'), h5py.File(f'{name}.response.h5')
        b = response[f'branch_{branch}']
        kept = list(b['modal/point'][:]).index(point)
        self.frequency, self.probe = b['frequency'][point], b['probe'][point, 0]
        amplitude, force = b['modal/amplitude'][kept], b['modal/force'][kept]
        self.u, self.s = [], []
        for k in range(len(amplitude)):
            at, turn = self.group(modal, response, k)
            u = np.tensordot(amplitude[k], turn(at['modes/shape'][:]), 1)
            s = np.tensordot(amplitude[k], turn(at['modes/stress'][:]), 1)
            if 'residual' in at:
                weight = at['residual/load_weight'][:]
                load = b['modal/scale'][kept] * weight[k] if k < len(weight) else 0 * weight[0]
                by = np.hstack([force[k], load])
                u = u + np.tensordot(by, turn(at['residual/shape'][:]), 1)
                s = s + np.tensordot(by, turn(at['residual/stress'][:]), 1)
            self.u.append(u)
            self.s.append(s)
        self.u, self.s = np.array(self.u), np.array(self.s)
        modal = modal['nodal_diameter_0'] if 'nodal_diameter_0' in modal else modal
        shape, self.nodes = modal['modes/shape'][:], modal.file['mesh/nodes'][:]
        self.tip = int(np.argmin(np.linalg.norm(self.nodes - [0, 0, 0.466], axis=1)))
        axial, x = np.array([1, 0, 0]), self.nodes[self.tip]
        radial = x - axial * (axial @ x)
        radial /= np.linalg.norm(radial)
        self.axes = np.array([np.cross(axial, radial), axial, radial])
        assert largest(shape[:, self.tip] @ self.axes.T - modal['probe/shape'][0].T) < 1e-12

    @staticmethod
    def group(modal, response, k):
        """The model of harmonic k, and what makes its fields of those in the file."""
        if 'nodal_diameter_0' not in modal:
            return modal, lambda field: field.astype(float)
        blades = modal.attrs['blades']
        wave = k * response.attrs['engine_order'] % blades
        plain = wave <= blades - wave
        at = modal[f'nodal_diameter_{wave if plain else blades - wave}']

        def turn(field):
            if field.dtype.names:
                field = field['r'].astype(float) + 1j * field['i'].astype(float)
            return field if plain else field.conj()
        return at, turn

    def at(self, instant, field, lag=0):
        k = np.arange(len(field))
        return np.real(np.tensordot(np.exp(1j * k * (2 * np.pi * instant - lag)), field, 1))


def rotation(angle):
    """About x, the engine axis."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])


def signed_mises(s):
    """By eigenvalues: another way than the program's."""
    xx, yy, zz, xy, yz, xz = np.moveaxis(s, -1, 0)
    principal = np.linalg.eigvalsh(np.moveaxis(
        np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]), [0, 1], [-2, -1]))
    a, b, c = np.moveaxis(principal, -1, 0)
    sign = np.where(np.abs(c) >= np.abs(a), np.sign(c), np.sign(a))
    return sign * np.sqrt(((a - b)**2 + (b - c)**2 + (c - a)**2) / 2)


def check_structure(file, copies):
    """What the format prescribes for an unstructured grid with steps and one part."""
    g = file['VTKHDF']
    assert list(g.attrs['Version']) == [2, 0] and g.attrs['Type'] == b'UnstructuredGrid'
    n, cells, ids = (int(g[name][0]) for name in ('NumberOfPoints', 'NumberOfCells',
                                                  'NumberOfConnectivityIds'))
    assert g['Points'].shape == (n, 3) and g['Connectivity'].shape == (ids,)
    assert g['Offsets'].shape == (cells + 1,) and g['Types'].shape == (cells,)
    assert g['Offsets'][-1] == ids and g['Connectivity'][:].max() == n - 1
    steps = g['Steps']
    count = int(steps.attrs['NSteps'])
    for name in ('Values', 'PartOffsets', 'PointOffsets', 'NumberOfParts'):
        assert steps[name].shape == (count,), name
    for name in ('CellOffsets', 'ConnectivityIdOffsets'):
        assert steps[name].shape == (count, 1), name
    assert (steps['NumberOfParts'][:] == 1).all() and not steps['PartOffsets'][:].any()
    for name, data in g['PointData'].items():
        offset = steps['PointDataOffsets'][name][:]
        assert offset.shape == (count,) and offset.max() + n == len(data), name
        assert 'units' in data.attrs and 'long_name' in data.attrs
    assert ('blade' in g['CellData']) == (copies > 1) if 'CellData' in g else copies == 1
    return g, n, count


def check_blade(name, branch, point, path, steps):
    p = Point(name, branch, point)
    with h5py.File(path) as file:
        g, n, count = check_structure(file, 1)
        assert count == steps and n == len(p.nodes)
        time = g['Steps/Values'][:]
        check('times', largest(time * p.frequency - np.arange(steps) / steps), 1e-14)
        assert largest(g['Points'][:] - p.nodes) == 0
        u = g['PointData/displacement'][:].reshape(steps, n, 3)
        s = g['PointData/stress'][:].reshape(steps, n, 6)
        mises = g['PointData/von_mises'][:].reshape(steps, n)
    mine_u = np.array([p.at(t / steps, p.u) for t in range(steps)])
    mine_s = np.array([p.at(t / steps, p.s) for t in range(steps)])
    mine_m = signed_mises(mine_s)
    check('displacement', largest(u - mine_u) / largest(mine_u), 1e-12)
    check('stress, single precision', largest(s - mine_s) / largest(mine_s), 1e-7)
    check('von Mises', largest(np.abs(mises) - np.abs(mine_m)) / largest(mine_m), 1e-7)
    assert (np.sign(mises) == np.sign(mine_m)).mean() > 0.999
    tip = np.array([p.at(t / steps, p.probe.T) for t in range(steps)])
    return largest(u[:, p.tip] @ p.axes.T - tip) / largest(tip)


def check_static(name, path):
    with h5py.File(f'{name}.modal.h5') as modal, h5py.File(path) as file:
        data = file['VTKHDF/PointData']
        assert largest(data['static_displacement'][:] - modal['static/displacement'][:]) == 0
        assert largest(data['static_stress'][:] - modal['static/nodal_stress'][:]) == 0
        assert not file['VTKHDF/Steps/PointDataOffsets/static_stress'][:].any()


def check_ring_motion(name, branch, point, path, steps, blades, order):
    p = Point(name, branch, point)
    n, worst, right = len(p.nodes), 0, 0
    with h5py.File(path) as file:
        g, points, count = check_structure(file, blades)
        assert points == n * blades and count == steps
        x = g['Points'][:].reshape(blades, n, 3)
        u = g['PointData/displacement'][:].reshape(steps, blades, n, 3)
        mises = g['PointData/von_mises'][:].reshape(steps, blades, n)
        assert list(np.unique(g['CellData/blade'][:])) == list(range(blades))
    for b in range(blades):
        turn = rotation(2 * np.pi * b / blades)
        right = max(right, largest(x[b] - p.nodes @ turn.T))
        for t in range(steps):
            wanted = p.at(t / steps, p.u, 2 * np.pi * b * order / blades) @ turn.T
            worst = max(worst, largest(u[t, b] - wanted))
    check('places of the blades', right, 1e-15 * 10)
    check('ring, single precision', worst / largest(u), 1e-7)
    return mises


def check_ring(name, branch, point, path, steps, blades, order):
    mises = check_ring_motion(name, branch, point, path, steps, blades, order)
    # in whole steps the lag is exact: blade b at t is blade 0 at t - b E/N
    assert steps % blades == 0
    shifted = [np.roll(mises[:, 0], b * order * steps // blades, axis=0) for b in range(blades)]
    check('stress of the blades', max(largest(mises[:, b] - shifted[b]) for b in range(blades)) /
          largest(mises), 1e-6)


def check_sides(path, blades):
    """Where two sectors meet, both move alike and have the same stress, at every step."""
    with h5py.File('disc.modal.h5') as modal, h5py.File(path) as file:
        nodes = modal['mesh/nodes'][:]
        right, left = (np.unique(modal[f'mesh/sets/cyclic_{side}'][:]) for side in
                       ('right', 'left'))
        n, data = len(nodes), file['VTKHDF/PointData']
        u = data['displacement'][:].reshape(-1, blades, n, 3)
        mises = data['von_mises'][:].reshape(-1, blades, n)
    there = nodes[left] @ rotation(2 * np.pi / blades).T
    partner = [left[np.linalg.norm(there - x, axis=1).argmin()] for x in nodes[right]]
    for name, field in ('displacement', u), ('von Mises', np.abs(mises)):
        jump = field[:, :, right] - np.roll(field, -1, axis=1)[:, :, partner]
        check(f'{name} where sectors meet', largest(jump) / largest(field[:, :, right]), 1e-6)


def check_vtk(path):
    """VTK before 9.3 reads the file as one of version 1.0: the first step."""
    try:
        import vtk
    except ImportError:
        print('no VTK')
        return
    with h5py.File(path, 'r+') as file:
        g = file['VTKHDF']
        g.attrs.modify('Version', np.array([1, 0]))
        del g['Steps']
        n, cells = int(g['NumberOfPoints'][0]), int(g['NumberOfCells'][0])
        u, s = g['PointData/displacement'][:n], g['PointData/stress'][:n]
    reader = vtk.vtkHDFReader()
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    assert grid.GetNumberOfPoints() == n and grid.GetNumberOfCells() == cells
    from vtk.util.numpy_support import vtk_to_numpy
    data = grid.GetPointData()
    assert largest(vtk_to_numpy(data.GetArray('displacement')) - u) == 0
    assert largest(vtk_to_numpy(data.GetArray('stress')) - s) == 0
    print('VTK', vtk.vtkVersion().GetVTKVersion(), 'reads', n, 'nodes')


SIZE = {5121: 1, 5125: 4, 5126: 4}
WIDTH = {'SCALAR': 1, 'VEC3': 3, 'VEC4': 4}
KIND = {5121: np.uint8, 5125: np.uint32, 5126: np.float32}


def read_glb(path):
    """Chunks, alignment, bounds of views and accessors; returns the JSON and all accessors."""
    with open(path, 'rb') as source:
        text = source.read()
    magic, version, length = struct.unpack('<4sII', text[:12])
    assert magic == b'glTF' and version == 2 and length == len(text)
    n, kind = struct.unpack('<I4s', text[12:20])
    assert kind == b'JSON' and n % 4 == 0
    scene = json.loads(text[20:20 + n])
    m, kind = struct.unpack('<I4s', text[20 + n:28 + n])
    assert kind == b'BIN\0' and m % 4 == 0 and 28 + n + m == len(text)
    binary = text[28 + n:]
    assert scene['buffers'][0]['byteLength'] == m
    arrays, end = [], 0
    for a in scene['accessors']:
        view = scene['bufferViews'][a['bufferView']]
        width, each = WIDTH[a['type']], SIZE[a['componentType']]
        assert view['byteOffset'] % 4 == 0 and view['byteOffset'] >= end
        end = view['byteOffset'] + view['byteLength']
        assert end <= m and view['byteLength'] == a['count'] * width * each
        data = np.frombuffer(binary, KIND[a['componentType']], a['count'] * width,
                             view['byteOffset']).reshape(-1, width)
        if 'min' in a:
            assert (data.min(0) == np.float32(a['min'])).all()
            assert (data.max(0) == np.float32(a['max'])).all()
        arrays.append(data)
    return scene, arrays


def check_scene(name, branch, point, path, steps, blades):
    p = Point(name, branch, point)
    scene, arrays = read_glb(path)
    extras, mesh = scene['asset']['extras'], scene['meshes'][0]
    part = mesh['primitives'][0]
    place = arrays[part['attributes']['POSITION']].astype(float)
    targets = [arrays[t['POSITION']].astype(float) for t in part['targets']]
    corners = arrays[part['indices']].reshape(-1, 3)
    assert corners.max() == len(place) - 1 and len(mesh['weights']) == len(targets)
    edges = np.sort(np.vstack([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), 1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all(), 'the surface is closed'
    a, b, c = (place[corners[:, i]] for i in range(3))
    volume = np.einsum('ij,ij', a, np.cross(b, c)) / 6
    assert volume > 0, 'triangles point outward'
    scale = extras['displacement_scale']
    still = p.nodes + scale * p.u[0].real
    distance = np.linalg.norm(still[None] - place[:, None], axis=2) if len(place) < 3000 else None
    node = distance.argmin(1)
    check('places of the scene', distance.min(1).max(), 1e-7)
    shown = extras['harmonics']
    only = np.zeros_like(p.u)
    only[shown] = p.u[shown]
    left_out = largest(np.delete(p.u, [0] + shown, axis=0)) if len(shown) < len(p.u) - 1 else 0
    check('harmonics left out', left_out / largest(p.u), 2e-3)
    worst, channels = 0, scene['animations'][0]['channels']
    assert len(channels) == blades
    for channel in channels:
        blade = channel['target']['node'] - 1
        sampler = scene['animations'][0]['samplers'][channel['sampler']]
        weight = arrays[sampler['output']].reshape(steps + 1, len(targets))
        assert len(arrays[sampler['input']]) == steps + 1 and (weight[0] == weight[-1]).all()
        lag = 2 * np.pi * blade * extras['engine_order'] / blades
        for t in range(steps):
            moved = sum(w * target for w, target in zip(weight[t], targets))
            worst = max(worst, largest(moved - scale * p.at(t / steps, only, lag)[node]))
    check('motion of the scene', worst / scale / largest(p.u), 1e-6)
    for b in range(blades):
        x, y, z, w = scene['nodes'][b + 1]['rotation']
        assert abs(x - np.sin(np.pi * b / blades)) < 1e-8 and y == z == 0
    s = np.array([p.at(t / 64, p.s) for t in range(64)])
    most = np.abs(signed_mises(s))[:, np.unique(node)].max()
    check('greatest stress', abs(extras['greatest_von_mises_Pa'] / most - 1), 1e-7)


def without_residuals():
    """Modes alone, so that probe and field rest on the same terms."""
    with h5py.File('blade.modal.h5') as source, h5py.File('own.modal.h5', 'w') as out:
        for name, value in source.attrs.items():
            out.attrs[name] = value
        for name in source:
            if name not in ('VTKHDF', 'residual', 'residual_modes', 'receptance', 'static'):
                source.copy(name, out)
        for group in ('contact', 'load', 'probe'):
            for name in list(out[group]):
                if any(word in name for word in ('residual', 'inertia', 'fourth')):
                    del out[group][name]


def disc_of_blades():
    """The blade as a disc that couples nothing: the same model at every nodal diameter."""
    with h5py.File('own.modal.h5') as source, h5py.File('rigid.modal.h5', 'w') as out:
        for name, value in source.attrs.items():
            out.attrs[name] = value
        out.attrs['format_version'] = np.int32(3)
        out.attrs['blades'] = np.int32(BLADES)
        out.attrs['nodal_diameters'] = np.arange(BLADES // 2 + 1, dtype=np.int32)
        source.copy('mesh', out)
        for n in range(BLADES // 2 + 1):
            group = out.create_group(f'nodal_diameter_{n}')
            for name in source:
                if name != 'mesh':
                    source.copy(name, group)


def check_rigid_disc(branch, point):
    """A disc that couples nothing moves as the clamped blades do, all round the ring."""
    disc_of_blades()
    write('rigid.yaml', OWN.replace('own', 'rigid'))
    run('shroudhb', 'mhb', '--quiet', 'rigid.yaml')
    run('shroudhb', 'field', '--ring', '--steps', '14', 'rigid.response.h5')
    with h5py.File('own.ring.vtkhdf') as own, h5py.File('rigid.ring.vtkhdf') as file:
        assert (file.attrs['branch'], file.attrs['point']) == (branch, point)
        for name in 'displacement', 'von_mises':
            a, b = (f[f'VTKHDF/PointData/{name}'][:] for f in (file, own))
            check(f'{name} on a disc that couples nothing', largest(a - b) / largest(b), 1e-6)


def check_disc():
    """A sector of a disc that gives: its fields by sums of the nodal diameters' own."""
    write('disc.yaml', DISC)
    run('shroudhb', 'run', '--quiet', 'disc.yaml')
    for order in 56, 4:
        run('shroudhb', 'mhb', '--quiet', '--set', f'excitation.engine_order={order}', 'disc.yaml')
        run('shroudhb', 'field', '--steps', '6', 'disc.response.h5')
        run('shroudhb', 'field', '--ring', '--steps', '4', 'disc.response.h5')
        with h5py.File('disc.field.vtkhdf') as file:
            branch, point = int(file.attrs['branch']), int(file.attrs['point'])
        far = check_blade('disc', branch, point, 'disc.field.vtkhdf', 6)
        check('probe of a disc, by what the residual columns leave out', far, 1e-4)
        check_static('disc', 'disc.field.vtkhdf')
        check_ring_motion('disc', branch, point, 'disc.ring.vtkhdf', 4, 60, order)
        check_sides('disc.ring.vtkhdf', 60)
    run('shroudhb', 'post', '--quiet', 'disc.yaml', '--set', 'excitation.engine_order=4')
    with open('disc.stress.csv', newline='') as table:
        rows = [r for r in csv.DictReader(table)
                if int(r['branch']) == branch and int(r['point']) == point]
    p = Point('disc', branch, point)
    s = np.array([p.at(t / 96, p.s) for t in range(96)])
    mises = signed_mises(s - p.s[0].real)
    wanted = (mises.max(0) - mises.min(0)).max() / 2
    first = next(r for r in rows if r['place'] == '1')
    check('worst stress', abs(max(float(r['amplitude_Pa']) for r in rows) / wanted - 1), 5e-3)
    assert float(first['safety']) > 0
    with open('disc.gauge.csv', newline='') as source:
        row = next(r for r in csv.DictReader(source)
                   if int(r['branch']) == branch and int(r['point']) == point)
    assert float(row['amplitude']) > 0


def check_modes():
    """Modes of the modal file: one sector by nodal diameter, and the wave around all of them."""
    theta = 2 * np.pi / 60
    for n, mode in ((0, 1), (4, 2), (12, 3)):
        words = ('shroudhb', 'field', '--steps', '8', '--mode', str(mode))
        run(*words, '--nodal-diameter', str(n), 'disc.modal.h5')
        run(*words, '--nodal-diameter', str(n), '--ring', 'disc.modal.h5')
        with h5py.File('disc.modal.h5') as file:
            group = file[f'nodal_diameter_{n}/modes']
            shape, stress, hz = (group[k][mode - 1] for k in ('shape', 'stress', 'frequency'))
            shape, stress = (x['r'] + 1j * x['i'] if x.dtype.names else x for x in (shape, stress))
        nodes = len(shape)
        instants = np.exp(2j * np.pi * np.arange(3600) / 3600)[:, None]
        axes = (np.abs(shape) ** 2).sum(1), np.abs((shape ** 2).sum(1))
        scale = 1e-3 / np.sqrt((axes[0] + axes[1]).max() / 2)
        worst = np.argmax(axes[0] + axes[1])
        over = np.linalg.norm(np.real(scale * shape[worst] * instants), axis=1).max()
        check(f'nodal diameter {n}, mode {mode}: greatest displacement',
              abs(over / 1e-3 - 1), 1e-5)
        with h5py.File(f'disc.field_mode_{n}_{mode}.vtkhdf') as file:
            check_structure(file, 1)
            assert file.attrs['mode'] == mode and file.attrs['nodal_diameter'] == n
            assert 'branch' not in file.attrs
            vtk = file['VTKHDF']
            u, s = vtk['PointData/displacement'][:], vtk['PointData/stress'][:]
            check('period of the mode', abs(vtk['Steps/Values'][1] * 8 * hz - 1), 1e-12)
            for step in range(8):
                turn = scale * np.exp(2j * np.pi * step / 8)
                rows = slice(step * nodes, (step + 1) * nodes)
                check('motion of the mode', largest(u[rows] - np.real(turn * shape)) / 1e-3, 1e-12)
                check('stress of the mode', largest(s[rows] - np.real(turn * stress)) /
                      largest(scale * stress), 2e-7)
        with h5py.File(f'disc.ring_mode_{n}_{mode}.vtkhdf') as file:
            check_structure(file, 60)
            u = file['VTKHDF/PointData/displacement'][:].reshape(8, 60, nodes, 3)
            for b in (0, 1, 17, 59):
                late = scale * np.exp(2j * np.pi / 8 * 3 - 1j * n * theta * b)
                wanted = np.real(late * shape) @ rotation(2 * np.pi * b / 60).T
                check('sector of the wave', largest(u[3, b] - wanted) / 1e-3, 1e-6)
        check_sides(f'disc.ring_mode_{n}_{mode}.vtkhdf', 60)
        check_vtk(f'disc.field_mode_{n}_{mode}.vtkhdf')
    run('shroudhb', 'field', '--quiet', '--mode', '2', 'blade.modal.h5')
    with h5py.File('blade.field_mode_2.vtkhdf') as file, h5py.File('blade.modal.h5') as modal:
        shape = modal['modes/shape'][1]
        scale = 1e-3 / np.linalg.norm(shape, axis=1).max()
        check('mode of a clamped blade',
              largest(file['VTKHDF/PointData/displacement'][:len(shape)] - scale * shape), 1e-15)
        assert 'nodal_diameter' not in file.attrs
    field = ['shroudhb', 'field']
    refused(field + ['--mode', '9', 'disc.modal.h5'],
            '--mode 9: disc.modal.h5 has the modes 1 to 8')
    refused(field + ['--mode', '1', '--nodal-diameter', '31', 'disc.modal.h5'],
            '--nodal-diameter 31: disc.modal.h5 does not hold it')
    refused(field + ['--mode', '1', '--nodal-diameter', '0', 'blade.modal.h5'],
            '--nodal-diameter: blade.modal.h5 holds a clamped blade')
    refused(field + ['--mode', '1', '--ring', 'blade.modal.h5'],
            '--ring: blade.modal.h5 holds the modes of one clamped blade')
    refused(field + ['--nodal-diameter', '1', 'disc.modal.h5'], '--nodal-diameter needs --mode')
    refused(field + ['--mode', '1', '--peak', '1', 'disc.modal.h5'], '--mode needs no --branch')


def check_gauge():
    """Against Hooke's law for the nodal stress at the nearest node: both err by the mesh size."""
    with open('blade.gauge.csv', newline='') as source:
        rows = list(csv.DictReader(source))
    assert all(row['gauge'] == 'g1' for row in rows)
    row = max(rows, key=lambda row: float(row['amplitude']))
    p = Point('blade', int(row['branch']), int(row['point']))
    node = int(np.argmin(np.linalg.norm(p.nodes - [-0.018, 0.003, 0.38], axis=1)))
    along = np.array([0.2, 0, 1]) / np.hypot(0.2, 1)
    xx, yy, zz, xy, yz, xz = p.s[1, node]
    pull = along @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ along
    strain = abs((1.3 * pull - 0.3 * (xx + yy + zz)) / 205e9)
    check('gauge against Hooke', abs(float(row['amplitude']) / strain - 1), 0.1)
    with h5py.File('blade.modal.h5') as modal:
        xx, yy, zz, xy, yz, xz = modal['static/nodal_stress'][node]
    pull = along @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ along
    check('static strain against Hooke',
          abs(float(row['static']) / ((1.3 * pull - 0.3 * (xx + yy + zz)) / 205e9) - 1), 0.1)


def check_materials():
    """The summary has the safety of the table, by the line of each material."""
    begin, end = CASE.index('mesh:'), CASE.index('rotor:')
    case = CASE[:begin] + 'mesh: {file: blade.msh}\n' + CASE[end:]
    lines = ('materials:\n  - {group: body, E: 205 GPa, nu: 0.3, rho: 7850, '
             'fatigue: {endurance: 300 MPa, ultimate: 900 MPa}}')
    write('list.yaml', case.replace('name: blade', 'name: list')
          .replace('material: {E: 205 GPa, nu: 0.3, rho: 7850}', lines))
    run('shroudhb', 'run', '--quiet', '--no-report', 'list.yaml')
    with open('list.stress.csv', newline='') as table:
        rows = {(int(r['branch']), int(r['point'])): r for r in csv.DictReader(table)
                if r['place'] == '1'}
    with open('list.summary.json') as file:
        peaks = [curve['peak'] for curve in json.load(file)['curves']]
    worst = max(abs(p['stress']['safety'] / float(rows[p['branch'], p['point']]['safety']) - 1)
                for p in peaks)
    check('safety', worst, 1e-11)


def check_face():
    """NAME.face.vtkhdf is a row of the maps in the response; the page shows uneven ones."""
    run('shroudhb', 'run', '--quiet', 'blade.yaml', '--set', 'contact.points=all', '--set',
        'name=face', '--set', 'contact.n0=60 N')
    with open('face.html') as page:
        pictures = page.read().count('<svg xmlns="http://www.w3.org/2000/svg" id="face-')
    assert pictures > 0
    told = run('shroudhb', 'field', '--face', 'face.response.h5')
    with h5py.File('face.face.vtkhdf') as file, h5py.File('face.response.h5') as r:
        branch, point, g = file.attrs['branch'], file.attrs['point'], file['VTKHDF']
        assert f'branch {branch}, point {point}: {file.attrs["frequency"]:.6g} Hz' in told, told
        maps, data = r[f'branch_{branch}/face'], g['PointData']
        row = list(maps['point'][:]).index(point)
        for name in 'pressure', 'slip', 'dissipation':
            assert (data[name][:] == maps[name][row]).all(), name
        for i, name in enumerate(('stuck', 'slipping', 'open')):
            assert (data[name][:] == maps['state'][row][:, i]).all(), name
        assert (g['Points'][:] == r['contact_face/nodes'][:]).all()
        work = r['contact_face/area'][:] @ data['dissipation'][:]
        check('work on the face', abs(work / r[f'branch_{branch}/dissipation'][point].sum() - 1),
              1e-12)
        nodes, cells = int(g['NumberOfPoints'][0]), int(g['NumberOfCells'][0])
        others = [i for i in range(max(maps['point'][:]) + 2) if i not in maps['point'][:]]
    refused(['shroudhb', 'field', '--face', '--branch', str(branch), '--point', str(others[0]),
             'face.response.h5'], 'is no peak; the nearest is')
    refused(['shroudhb', 'field', '--face', '--ring', 'face.response.h5'], '--face needs no --ring')
    refused(['shroudhb', 'field', '--face', '--branch', '0', 'face.response.h5'],
            'no peak of this branch has maps')
    refused(['shroudhb', 'field', '--face', '--peak', '99', 'face.response.h5'], 'there are')
    refused(['shroudhb', 'field', '--face', 'own.response.h5'], 'no peak has maps')
    try:
        import vtk
    except ImportError:
        return
    reader = vtk.vtkHDFReader()
    reader.SetFileName('face.face.vtkhdf')
    reader.Update()
    grid = reader.GetOutput()
    assert (grid.GetNumberOfPoints(), grid.GetNumberOfCells()) == (nodes, cells)
    size = vtk.vtkCellSizeFilter()
    size.SetInputData(grid)
    size.Update()
    area = size.GetOutput().GetCellData().GetArray('Area')
    total = sum(area.GetValue(i) for i in range(cells))
    with h5py.File('face.response.h5') as r:
        check('area by VTK', abs(total / r['contact_face/area'][:].sum() - 1), 1e-6)


def main():
    write('blade.yaml', CASE)
    write('own.yaml', OWN)
    run('shroudhb', 'run', '--quiet', 'blade.yaml')
    check_gauge()
    check_materials()
    with h5py.File('blade.response.h5') as r:
        points = r['branch_2/modal/point'][:]
    point = int(points[-1])
    told = run('shroudhb', 'field', 'blade.response.h5')
    assert 'blade.field.vtkhdf' in told and 'static part' in told
    with h5py.File('blade.field.vtkhdf') as file:
        branch, highest = int(file.attrs['branch']), int(file.attrs['point'])
    far = check_blade('blade', branch, highest, 'blade.field.vtkhdf', 24)
    check('probe, by what the residual columns leave out', far, 1e-4)
    check_static('blade', 'blade.field.vtkhdf')
    check_scene('blade', branch, highest, 'blade.field.glb', 24, 1)
    check_vtk('blade.field.vtkhdf')
    run('shroudhb', 'field', '--branch', '2', '--point', str(point), '--steps', '5',
        'blade.response.h5')
    check_blade('blade', 2, point, f'blade.field_2_{point}.vtkhdf', 5)

    without_residuals()
    run('shroudhb', 'mhb', '--quiet', 'own.yaml')
    run('shroudhb', 'field', '--quiet', '--ring', '--steps', '14', 'own.response.h5')
    run('shroudhb', 'field', '--peak', '1', '--branch', '2', '--steps', '9', 'own.response.h5')
    with h5py.File('own.ring.vtkhdf') as file:
        branch, highest = int(file.attrs['branch']), int(file.attrs['point'])
    check('probe, modes alone', check_blade(
        'own', branch, highest, f'own.field_{branch}_{highest}.vtkhdf', 9), 1e-10)
    check_ring('own', branch, highest, 'own.ring.vtkhdf', 14, BLADES, ORDER)
    check_scene('own', branch, highest, 'own.ring.glb', 14, BLADES)
    check_rigid_disc(branch, highest)
    check_disc()
    check_modes()

    check_face()
    free = next(i for i in range(10**6) if i not in points)
    refused(['shroudhb', 'field', '--branch', '2', '--point', str(free), 'blade.response.h5'],
            'was not kept, the nearest is')
    refused(['shroudhb', 'field', '--branch', '99', 'blade.response.h5'], 'has the branches 0 to')
    refused(['shroudhb', 'field', '--point', '3', 'blade.response.h5'], '--point needs --branch')
    refused(['shroudhb', 'field', '--peak', '9999', 'blade.response.h5'], '--peak 9999: there are')
    refused(['shroudhb', 'field', '--steps', '1', 'blade.response.h5'], 'a number from 2 to 1000')
    refused(['shroudhb', 'field', '--scale', 'x', 'blade.response.h5'], 'a number above 0')
    refused(['shroudhb', 'field', '--modal', 'blade.response.h5', 'blade.response.h5'],
            'has no /mesh or no modes/stress')
    run('shroudhb', 'field', 'absent.response.h5', code=4)


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    main()
