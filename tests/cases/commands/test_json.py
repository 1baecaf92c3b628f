"""cases.commands.json: --json and NAME.summary.json: syntax, keys against the page, errors.

Usage: test_json.py SHROUDHB CASE_FOLDER PAGE. Exit code 77: h5py is missing.
"""
import json
import os
import re
import subprocess
import sys

try:
    import h5py
    import numpy as np
except ImportError:
    sys.exit(77)

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../support'))
from programs import bring_your_own

SHROUDHB, SCENE, PAGE = (os.path.abspath(word) for word in sys.argv[1:4])


def refuse(word):
    raise AssertionError(f'{word} is not JSON')


def run(*words, code=0):
    done = subprocess.run([SHROUDHB, *words], capture_output=True, text=True, timeout=300)
    if done.returncode != code:
        raise AssertionError(f'{words}: code {done.returncode}, not {code}\n{done.stderr}')
    return json.loads(done.stdout, parse_constant=refuse)


def paths(value, prefix=''):
    """Keys of a document, those of a list's elements joined to the key of the list."""
    if isinstance(value, list):
        return set().union(*(paths(one, prefix) for one in value)) if value else set()
    found = set()
    if isinstance(value, dict):
        for key, inner in value.items():
            full = f'{prefix}.{key}' if prefix else key
            found |= {full} | paths(inner, full)
    return found


def documented():
    text = open(PAGE, encoding='utf-8').read()
    part = text[text.index('## A case'):text.index('## A study')]
    rows = [line.split('|')[1] for line in part.splitlines() if line.startswith('| `')]
    return {key for row in rows for key in re.findall('`([^`]+)`', row)}


def errors():
    wrong = run('check', '--json', 'none.yaml', code=4)['error']
    assert wrong['kind'] == 'input or output failed' and 'none.yaml' in wrong['messages'][0], wrong
    with open('bad.yaml', 'w') as out:
        out.write('mesh: {file: 3}\nmaterial: steel\n')
    for command in ('check', 'modal', 'mhb', 'run', 'post', 'converge'):
        wrong = run(command, '--json', 'bad.yaml', code=2)['error']
        assert wrong['code'] == 2 and wrong['kind'] == 'bad input', wrong
        assert any('bad.yaml:2:11: error: material' in text for text in wrong['messages']), wrong
    assert run('inspect', '--json', 'bad.yaml', code=4)['error']['code'] == 4
    assert run('mhb', '--json', '--nonsense', 'bad.yaml', code=2)['error']['messages']


def bracket():
    """Modes alone: the summary has no curves."""
    with open('bracket.geo', 'w') as out:
        out.write('SetFactory("OpenCASCADE");\nBox(1) = {0, 0, 0.1, 0.02, 0.01, 0.1};\n'
                  'Physical Volume("all") = {1};\nPhysical Surface("root") = {5};\n'
                  'Mesh.ElementOrder = 2;\nMesh.MeshSizeMax = 0.01;\n')
    with open('bracket.yaml', 'w') as out:
        out.write('mesh: {file: bracket.geo}\nmaterial: {E: 207 GPa, nu: 0.29, rho: 7850}\n'
                  'rotor: {speed: 3000 rpm}\nmodal: {modes: 3}\n')
    result = run('modal', '--json', 'bracket.yaml')
    assert abs(result['mass'] - 0.157) < 1e-9 and len(result['modes']) == 3
    assert 'curves' not in result and result['static']['stress'] > 1e5
    assert result['modes'][0]['frequency'] < result['modes'][1]['frequency']
    assert len(result['modes'][0]['effective_mass']) == 3
    assert run('check', '--json', 'bracket.yaml')['modes_only'] is True
    return paths(result)


def scene():
    subprocess.run([sys.executable, 'write_modal.py'], check=True)
    result = run('run', '--json', '--no-report', 'case.yaml')
    with open('three_degree.summary.json', encoding='utf-8') as file:
        assert json.load(file) == result
    assert os.path.exists('three_degree.csv') and not os.path.exists('three_degree.html')
    curves = {(c['kind'], c['n0']): c for c in result['curves']}
    peak = curves['nonlinear', 0.3]['peak']
    with h5py.File('three_degree.response.h5') as file:
        branch = file[f"branch_{peak['branch']}"]
        x = branch['probe'][:, 0, :, 1]
        a = np.sqrt((np.sum(np.abs(x) ** 2, 1) + np.abs(np.sum(x * x, 1))) / 2)
        assert abs(peak['amplitude'] / a.max() - 1) < 1e-3, peak
        assert abs(peak['frequency'] / branch['frequency'][a.argmax()] - 1) < 1e-3, peak
    assert peak['stability'] in ('stable', 'modulated', 'unstable', 'not judged')
    assert curves['nonlinear', -0.2]['folds'] == 4
    assert ('open', None) in curves and ('stuck', None) in curves
    assert result['optimum']['n0'] == 0.3 and result['complete'] and result['finished']
    assert run('mhb', '--json', 'case.yaml') == result
    assert run('post', '--json', 'case.yaml') == result and os.path.exists('three_degree.html')
    alone = run('inspect', '--json', 'three_degree.response.h5')
    assert alone['curves'] == result['curves'] and alone['name'] is None
    both = run('post', '--json', 'case.yaml', 'three_degree.response.h5') # a run against itself
    assert all(c['amplitude_change'] in (0, None) for c in both['curves']), both
    assert both['settings'] == [] and len(both['curves']) > 3
    table = run('inspect', '--json', 'three_degree.response.h5', 'branch_2[0:3]')
    assert table['columns'][0] == 'index' and len(table['rows'][0]) == len(table['columns'])
    tracked = run('run', '--json', '--set', 'name=along', '--set', 'contact.n0=0.3',
                  '--set', 'mhb.vary={scale: [0.5, 1]}', '--set', 'mhb.frequency=0.2 Hz',
                  'case.yaml')
    assert tracked['parameter'] == 'scale'
    with open('study.yaml', 'w') as out:
        out.write('name: two\ncase: case.yaml\nvary: {contact.mu: [0.3, 0.4]}\nplan: grid\n'
                  'outputs: [peak, frequency]\n')
    assert run('check', '--json', 'study.yaml')['designs'] == 2
    study = run('study', '--json', '--quiet', 'study.yaml')
    assert [d['keys']['contact.mu'] for d in study['designs']] == [0.3, 0.4], study
    assert study['designs'][0]['outputs']['peak'] > 0 and study['designs_done'] == 2
    ladder = run('converge', '--json', '--set', 'contact.n0=0.3', '--set', 'contact.mu=0.5',
                 '--set', 'mhb.frequency=[0.2 Hz, 0.24 Hz]', '--set', 'converge.tolerance=0.5',
                 'case.yaml')
    assert ladder['rungs'] and all(rung['status'] == 'done' for rung in ladder['rungs'])
    with h5py.File('three_degree.converge.h5') as file:
        assert 'contact.mu = 0.5' in file.attrs['settings'].replace('0.50000000000000000', '0.5')
    return paths(result) | paths(tracked)


def main():
    with bring_your_own(SCENE):
        os.environ['OMPI_ALLOW_RUN_AS_ROOT'] = os.environ['OMPI_ALLOW_RUN_AS_ROOT_CONFIRM'] = '1'
        errors()
        found, page = bracket() | scene(), documented()
        rare = re.compile('stress|lasting|optimum.(param|error|verif|marked)')
        seldom = {key for key in page if rare.search(key)}
        print('not on the page:', sorted(found - page))
        print('not in the results:', sorted(page - found - seldom))
        assert found <= page and page - found <= seldom
        print(f'{len(found)} keys are those of the page')


main()
