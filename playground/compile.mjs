// node compile.mjs PYODIDE IN.zip OUT.zip: compiles the modules in an archive to byte code of the Python that will run them.
import { readFileSync, writeFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [pyodide, from, to] = process.argv.slice(2);

// Else node shows the line of the runtime in which it happened, which has a million characters.
process.on("uncaughtException", (error) => {
  console.error(error.message);
  process.exit(1);
});

const { loadPyodide } = await import(pathToFileURL(`${pyodide}/pyodide.mjs`));
const python = await loadPyodide({ indexURL: pyodide });
python.unpackArchive(new Uint8Array(readFileSync(from)), "zip", { extractDir: "/packages" });
python.runPython(`
import compileall, py_compile, zipfile
from pathlib import Path

top = Path("/packages")
mode = py_compile.PycInvalidationMode.UNCHECKED_HASH
if not compileall.compile_dir(top, maxlevels=20, quiet=1, legacy=True, invalidation_mode=mode):
    raise SystemExit("a module cannot be compiled")
with zipfile.ZipFile("/packages.zip", "w", zipfile.ZIP_DEFLATED) as archive:
    for path in sorted(top.rglob("*")):
        if path.is_file() and path.suffix != ".py":
            archive.write(path, path.relative_to(top))
`);
writeFileSync(to, python.FS.readFile("/packages.zip"));
