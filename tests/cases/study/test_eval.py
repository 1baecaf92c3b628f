"""cases.study.eval: a script in Dakota's place: both formats, active set, gradients, failures.

Usage: test_eval.py BIN CASE_FOLDER, with the programs in BIN. Exit code 77: h5py is missing.
"""
import os
import subprocess
import sys

try:
    import h5py # for write_modal.py
except ImportError:
    sys.exit(77)

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../support'))
from programs import bring_your_own

BIN, SCENE = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])


def standard(variables, responses, derivatives=()):
    names = list(variables)
    lines = [f'{len(variables):40d} variables']
    lines += [f'{value:40.16e} {name}' for name, value in variables.items()]
    lines += [f'{len(responses):40d} functions']
    lines += [f'{active:40d} ASV_{i + 1}:{name}' for i, (name, active) in enumerate(responses)]
    lines += [f'{len(derivatives):40d} derivative_variables']
    lines += [f'{names.index(name) + 1:40d} DVV_{i + 1}:{name}'
              for i, name in enumerate(derivatives)]
    return '\n'.join(lines + [f'{0:40d} analysis_components', f'{1:40d} eval_id']) + '\n'


def aprepro(variables, responses, derivatives=()):
    names = list(variables)
    pairs = [('DAKOTA_VARS', len(variables))] + list(variables.items())
    pairs += [('DAKOTA_FNS', len(responses))]
    pairs += [(f'ASV_{i + 1}:{name}', active) for i, (name, active) in enumerate(responses)]
    pairs += [('DAKOTA_DER_VARS', len(derivatives))]
    pairs += [(f'DVV_{i + 1}:{name}', names.index(name) + 1) for i, name in enumerate(derivatives)]
    pairs += [('DAKOTA_AN_COMPS', 0), ('DAKOTA_EVAL_ID', 1)]
    return ''.join(f'{{ {name:16s} = {value!r} }}\n' for name, value in pairs)


def evaluate(text, code=0):
    with open('params.in', 'w') as out:
        out.write(text)
    done = subprocess.run([os.path.join(BIN, 'shroudhb'), 'eval', 'case.yaml', '--params',
                           'params.in', '--results', 'results.out'],
                          capture_output=True, text=True, timeout=300)
    assert done.returncode == code, (done.returncode, done.stdout, done.stderr)
    with open('results.out') as source:
        return source.read(), done.stderr


def value_of(variables):
    text, _ = evaluate(standard(variables, [('peak', 1)]))
    return float(text.split()[0])


def check():
    variables = {'contact__n0': 0.3, 'contact__mu': 0.41}
    responses = [('peak', 3), ('frequency', 1), ('modes__1__frequency', 0)]
    text, _ = evaluate(standard(variables, responses, ['contact__mu', 'contact__n0']))
    lines = text.splitlines()
    assert [line.split()[1] for line in lines[:2]] == ['peak', 'frequency'], text
    assert lines[2].startswith('[') and lines[2].endswith(']') and len(lines) == 3, text
    other, _ = evaluate(aprepro(variables, responses, ['contact__mu', 'contact__n0']))
    assert other == text, (other, text)

    at = {'contact.n0': 0.3, 'mhb.scale': 1.0}
    text, _ = evaluate(standard(at, [('peak', 2)], list(at)))
    for name, gradient in zip(at, map(float, text.strip('[] \n').split())):
        step = 1e-3 * at[name]
        a, b, c, d = (value_of({**at, name: at[name] + k * step}) for k in (-2, -1, 1, 2))
        difference = (a - 8 * b + 8 * c - d) / (12 * step)
        print(f'{name}: gradient {gradient:.9f}, by differences {difference:.9f}')
        assert abs(gradient - difference) < 1e-6 * abs(gradient), (name, gradient, difference)

    for text, code, said in (
            (standard({'contact.n1': 1.0}, [('peak', 1)]), 2, 'is no key'),
            (standard({'contact.n0': 0.3}, [('peek', 1)]), 2, 'is no output'),
            (standard({'contact.mu': -1.0}, [('peak', 1)]), 2, 'contact.mu'),
            (standard({'contact.n0': 0.3}, [('frequency', 2)], ['contact.n0']), 3,
             'no derivative of frequency'),
            (standard({'contact.n0': 0.3}, [('peak', 4)]), 3, 'no Hessian'),
            ('nothing\n', 2, 'no parameters file')):
        result, errors = evaluate(text, code)
        assert result.startswith('FAIL'), result
        assert said in errors, errors


def check_counts():
    """What a parameters file announces stands there, and the active set is 0 to 7."""
    good = standard({'contact.n0': 0.3, 'contact.mu': 0.41}, [('peak', 1), ('frequency', 1)],
                    ['contact.n0'])
    plain = [line.split() for line in good.splitlines()]
    for number, tag, put, said in (
            ('2', 'variables', '1', '1 variables were announced'),
            ('2', 'variables', '3', '3 variables are announced, 2 stand there'),
            ('2', 'variables', '2x', 'expected a whole number'),
            ('2', 'functions', '3', '3 functions are announced, 2 stand there'),
            ('2', 'functions', '1', 'ASV_2:frequency is response 2, of 1'),
            ('1', 'derivative_variables', '2', '2 derivative variables are announced, 1 stand'),
            ('1', 'derivative_variables', '0', 'is derivative variable 1, of 0'),
            ('1', 'ASV_1:peak', 'x', 'expected a whole number from 0 to 7'),
            ('1', 'ASV_1:peak', '1.5', 'expected a whole number from 0 to 7'),
            ('1', 'ASV_1:peak', '8', 'expected a whole number from 0 to 7'),
            ('1', 'ASV_1:peak', '-1', 'expected a whole number from 0 to 7'),
            ('1', 'DVV_1:contact.n0', '3', 'expected a whole number from 1 to 2')):
        assert [number, tag] in plain, (number, tag)
        text = '\n'.join(f'{put} {tag}' if words == [number, tag] else ' '.join(words)
                         for words in plain) + '\n'
        result, errors = evaluate(text, 2)
        assert result.startswith('FAIL') and said in errors, (put, tag, errors)
        assert len(errors.splitlines()) == 1, errors
    for text, said in (
            (good.replace('contact.mu\n', 'contact.n0\n'), 'contact.n0 stands there twice'),
            (good.replace('ASV_2:frequency', 'ASV_2:peak'), 'response peak stands there twice')):
        assert said in evaluate(text, 2)[1], text
    assert evaluate(standard({'contact.n0': 0.3}, [('peak', 0)])) == ('', '')


def main():
    with bring_your_own(SCENE):
        subprocess.run([sys.executable, 'write_modal.py'], check=True)
        with open('case.yaml') as source:
            text = source.read()
        with open('case.yaml', 'w') as out:
            out.write(text.replace('n0: [-0.2 N, 0 N, 0.3 N, 1.0 N]', 'n0: 0.3 N'))
        check()
        check_counts()


main()
