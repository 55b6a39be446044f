/* Unpacks the viewer, one script, and the data that it reads, and runs it. All elements with data are digits of base 91
   (pictures/player_internal.h), most of them of deflated bytes. */
"use strict";
let data; /* the page's, for the viewer */
function packed(id) {
  const text = document.getElementById(id).textContent, pairs = text.length >> 1;
  const bytes = new Uint8Array((13 * pairs + 6 * (text.length & 1)) >> 3);
  const digit = i => (text[i] === "#" ? 60 : text.charCodeAt(i)) - 36; /* "#" stands for "<" */
  for (let i = 0, at = 0, bits = 0, count = 0; i < text.length; i += 2) {
    bits |= (digit(i) + (i + 1 < text.length ? 91 * digit(i + 1) : 0)) << count;
    for (count += i + 1 < text.length ? 13 : 6; count >= 8; count -= 8, bits >>= 8) bytes[at++] = bits;
  }
  return bytes;
}

async function inflated(id) {
  const {readable, writable} = new DecompressionStream("deflate-raw"), writer = writable.getWriter();
  const written = Promise.all([writer.write(packed(id)), writer.close()]); /* a Blob would go through another process */
  const [bytes] = await Promise.all([new Response(readable).arrayBuffer(), written]);
  return new Uint8Array(bytes);
}

/* What takes longest begins first: the module of live runs (src/live/live.h) is compiled while the viewer begins, once for all
   workers. A failure is told where the parts are used. */
const live_parts = document.getElementById("module") && Promise.all([inflated("module").then(bytes => WebAssembly.compile(bytes)),
  inflated("bundle")]);
live_parts?.catch(() => {});

Promise.all([inflated("viewer"), inflated("data")]).then(parts => {
  const script = document.createElement("script"), [code, json] = parts.map(bytes => new TextDecoder().decode(bytes));
  data = JSON.parse(json);
  script.textContent = code;
  document.body.append(script);
}).catch(() => {
  document.getElementById("summary").textContent = "DecompressionStream" in window
    ? "The page is damaged: its script cannot be unpacked."
    : "This browser cannot unpack the page, as it has no DecompressionStream. Browsers of 2023 and later have it.";
});
