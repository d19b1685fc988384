// Runs Python: starts it once, then answers what it is asked, one question after the other.
import { loadPyodide } from "./runtime/pyodide.mjs";

const FOLDER = "/packages";

async function start() {
  const archive = fetch("packages.zip").then((response) => response.arrayBuffer());
  const python = await loadPyodide();
  python.unpackArchive(await archive, "zip", { extractDir: FOLDER });
  python.runPython(`import sys; sys.path.insert(0, "${FOLDER}")`);
  return python.pyimport("playground.session");
}

const tell = (stage) => postMessage({ kind: "stage", stage });

function answer(python, session, { kind, text, version }) {
  if (kind === "check") {
    postMessage({ kind: "checked", version, problems: JSON.parse(python.check(text)) });
    return;
  }
  const begun = performance.now();
  const answered = JSON.parse(session.solve(text, tell));
  postMessage({ kind: "answered", version, ...answered, milliseconds: performance.now() - begun });
  postMessage({ kind: "reported", version, page: session.report(tell) });
}

const ready = start().then((python) => ({ python, session: python.Session() }));
ready.then(
  () => postMessage({ kind: "ready" }),
  (error) => postMessage({ kind: "broken", message: String(error) }),
);

onmessage = async ({ data }) => {
  const { python, session } = await ready;
  try {
    answer(python, session, data);
  } catch (error) {
    postMessage({ kind: "failed", version: data.version, message: String(error.message ?? error) });
  }
};
