"""The JSON documents of pages and their schemas (postproc/script)."""
import json
import re
from pathlib import Path

try:
    import jsonschema
except ImportError:
    jsonschema = None

SCRIPT = Path(__file__).resolve().parents[2] / 'postproc' / 'script'


def document(page):
    """The numbers of a page."""
    return json.loads(re.search(r' id="data">(.*?)</script>', page.read_text(), re.S).group(1))


def schema_of(kind):
    """The schema of "report" or "study"; None without jsonschema."""
    if not jsonschema:
        return None
    schema = json.loads((SCRIPT / f'{kind}.schema.json').read_text())
    jsonschema.Draft7Validator.check_schema(schema)
    return schema


def first_fault(schema, data):
    """What is wrong with a document, None if nothing is."""
    error = jsonschema.exceptions.best_match(jsonschema.Draft7Validator(schema).iter_errors(data))
    return f'{"/".join(map(str, error.path))}: {error.message:.200}' if error else None
