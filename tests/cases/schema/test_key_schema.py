"""test_key_schema.py SHROUDHB CASES: the schema accepts every shipped case, finds faults."""
import copy
import json
import pathlib
import subprocess
import sys

try:
    import jsonschema
    import yaml
except ImportError:
    sys.exit(77)

program, cases = sys.argv[1], pathlib.Path(sys.argv[2])
schema = json.loads(subprocess.run([program, "keys", "--schema"], check=True,
                                   capture_output=True).stdout)
jsonschema.Draft7Validator.check_schema(schema)
validator = jsonschema.Draft7Validator(schema)

files = sorted(cases.glob("*/case.yaml"))
assert len(files) > 5, files
for file in files:
    for error in validator.iter_errors(yaml.safe_load(file.read_text())):
        sys.exit(f"{file}: {error.json_path}: {error.message}")

good = yaml.safe_load((cases / "z_notch_blade/case.yaml").read_text())


def faults(change):
    case = copy.deepcopy(good)
    change(case)
    return len(list(validator.iter_errors(case)))


for name, change in {
    "misspelt key": lambda c: c["contact"].update(muu=0.3),
    "unknown block": lambda c: c.update(contacts={}),
    "unknown word": lambda c: c["contact"].update(preload="equal"),
    "below its range": lambda c: c["contact"].update(mu=-1),
    "text for a count": lambda c: c["rotor"].update(blades="forty"),
    "key of a list": lambda c: c["mesh"]["blade"]["sections"][0].update(cord=1),
    "key that a list needs": lambda c: c["mesh"]["blade"]["sections"][0].pop("chord"),
    "two numbers for three": lambda c: c["excitation"].update(traction=[1, 2]),
}.items():
    assert faults(change) > 0, name
motion = json.loads(subprocess.run([program, "keys", "--schema=motion"], check=True,
                                   capture_output=True).stdout)
jsonschema.Draft7Validator.check_schema(motion)
validator = jsonschema.Draft7Validator(motion)
for file in sorted((cases / "prescribed_motion").glob("*.yaml")):
    good = yaml.safe_load(file.read_text())
    for error in validator.iter_errors(good):
        sys.exit(f"{file}: {error.json_path}: {error.message}")
    good["motion"]["x"] = []
    assert list(validator.iter_errors(good)), "unknown signal"
    good["motion"] = {"v": 3}
    assert list(validator.iter_errors(good)), "no list"
study = json.loads(subprocess.run([program, "keys", "--schema=study"], check=True,
                                  capture_output=True).stdout)
jsonschema.Draft7Validator.check_schema(study)
validator = jsonschema.Draft7Validator(study)
files = sorted(cases.glob("*/study.yaml"))
assert len(files) > 1, files
for file in files:
    for error in validator.iter_errors(yaml.safe_load(file.read_text())):
        sys.exit(f"{file}: {error.json_path}: {error.message}")
good = yaml.safe_load("""
case: case.yaml
vary: {contact.n0: {from: 5 N, to: 9 N, scale: log}, "mesh.blade.sections[4].thickness": [4 mm, 5],
       "excitation.traction[0]": [1 Pa, 2 Pa]}
uncertain: {contact.mu: {normal: [0.3, 0.05]}}
samples: 72
plan: {sobol: 256, seed: 2}
outputs: [peak, "modes[1].frequency"]
""")
search = {"case": "case.yaml", "vary": good["vary"],
          "optimise": {"minimise": "peak", "at_most": {"stress": "80 MPa"}, "algorithm": "slope"}}
assert not list(validator.iter_errors(good)) and not list(validator.iter_errors(search))
for name, change in {
    "misspelt key": lambda c: c.update(varie={}),
    "path that is no key": lambda c: c["vary"].update({"contact.muu": [0.3]}),
    "key that is no number": lambda c: c["vary"].update({"contact.to": ["ground"]}),
    "range without its end": lambda c: c["vary"].update({"contact.n0": {"from": 5}}),
    "unknown distribution": lambda c: c["uncertain"].update({"contact.mu": {"norm": [1, 2]}}),
    "one number for two": lambda c: c["uncertain"].update({"contact.mu": {"normal": [1]}}),
    "no count": lambda c: c.update(plan={"sobol": "many"}),
    "unknown method": lambda c: c.update(optimise={"minimise": "peak", "algorithm": "best"}),
    "no case": lambda c: c.pop("case"),
}.items():
    bad = copy.deepcopy(good)
    change(bad)
    assert list(validator.iter_errors(bad)), name
print("case, motion and study files")
