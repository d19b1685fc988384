// A text in the fragment of an address, which browsers send to no server: deflated, in the base64 of addresses.

// Bytes of a deflated text that is read from an address.
const LONGEST = 1_000_000;

async function through(bytes, stream) {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
}

export async function fragmentOf(text) {
  const packed = await through(new TextEncoder().encode(text), new CompressionStream("deflate-raw"));
  const base64 = btoa(Array.from(packed, (byte) => String.fromCharCode(byte)).join(""));
  return `#spec=${base64.replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "")}`;
}

// The text in a fragment; null where there is none. Rejects what was damaged on the way.
export async function textIn(fragment) {
  if (!fragment.startsWith("#spec=")) return null;
  const base64 = fragment.slice("#spec=".length).replaceAll("-", "+").replaceAll("_", "/");
  const packed = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
  if (packed.length > LONGEST) throw new Error("it is too long");
  const text = await through(packed, new DecompressionStream("deflate-raw"));
  return new TextDecoder("utf-8", { fatal: true }).decode(text);
}
