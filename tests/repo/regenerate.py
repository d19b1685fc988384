"""Write everything that is generated and committed: `make regenerate`.

The parse table of the grammar, the JSON Schemas, the index of the map, the proofs of the examples, the table of
examples, the golden outputs, and the output shown in documents. Look at the difference before committing it.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

from tests.cli.golden import CASES, golden_path, produce
from tests.repo.documents import renewed
from tests.repo.examples import (
    EXAMPLES,
    README,
    certificate_path,
    certificate_text,
    proof_path,
    proof_text,
    with_table,
)
from tests.repo.index import MAP, with_index
from tests.repo.schemas import schemas
from tests.repo.test_documents import DOCUMENTS
from tumato_symbolic.syntax.compiling import compile_table
from tumato_symbolic.syntax.grammar import TABLE_PATH, grammar_path
from tumato_symbolic.syntax.table import written


def main() -> None:
    """Regenerate all of it."""
    grammar = grammar_path().read_text(encoding="utf-8")
    TABLE_PATH.write_text(written(compile_table(grammar), grammar), encoding="utf-8")
    for path, schema in schemas():
        path.write_text(schema, encoding="utf-8")
    MAP.write_text(with_index(MAP.read_text(encoding="utf-8")), encoding="utf-8")
    for example in EXAMPLES:
        for path, text in (
            (proof_path(example), proof_text(example)),
            (certificate_path(example), certificate_text(example)),
        ):
            if text is None:
                path.unlink(missing_ok=True)
            else:
                path.write_text(text)
    README.write_text(with_table(README.read_text()))
    for case in CASES:
        golden_path(case).write_text(produce(case))
    for document in DOCUMENTS:
        with tempfile.TemporaryDirectory() as folder:
            document.write_text(renewed(document.read_text(), Path(folder)))


if __name__ == "__main__":
    main()
