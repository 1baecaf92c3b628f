#!/usr/bin/env python3
"""The numbers of every page against their JSON Schema, which has a line for each of them.

    test_schema.py REPORT_MAKER STUDY_MAKER

The makers write pages of every kind into the folder (NOUN keep). A document with a member too many,
too few, or of another version must be refused.
"""
import copy
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / 'support'))
from page_schema import document, first_fault, schema_of

if not schema_of('report'):
    print('skipped: python3 has no jsonschema')
    sys.exit(77)

def faults_not_found(schema, data):
    """Documents that the schema takes although they are wrong."""
    for name in schema['required']:
        wrong = copy.copy(data)
        del wrong[name]
        yield f'without {name}', wrong
    yield 'another version', {**data, 'version': 2}
    yield 'a member too many', {**data, 'more': 1}
    yield 'a text for numbers', {**data, 'key' if 'key' in data else 'axes': 'x'}


def check(kind, pages):
    schema = schema_of(kind)
    seen, bad = set(), []
    for page in pages:
        data = document(page)
        seen |= set(data)
        fault = first_fault(schema, data)
        print(f'{page.name}: {fault or "good"}')
        bad += [fault] if fault else []
    for name, wrong in faults_not_found(schema, document(pages[0])):
        if not first_fault(schema, wrong):
            bad.append(f'{kind}: {name} is taken')
    print(f'{kind}: members in no page: {sorted(set(schema["properties"]) - seen)}')
    return bad


def main():
    report, study = sys.argv[1:]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for maker, noun in ((report, 'contact_points'), (report, 'blade_view'),
                            (study, 'study_page')):
            subprocess.run([Path(maker).resolve(), noun, 'keep'], cwd=folder, check=True,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        studies = sorted(folder.glob('*.study.html'))
        reports = sorted(set(folder.glob('page_*.html')) - set(studies))
        bad = check('report', reports) + check('study', studies)
    for fault in bad:
        print('  ' + fault)
    return 1 if bad or not reports or not studies else 0


if __name__ == '__main__':
    sys.exit(main())
