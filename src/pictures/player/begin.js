/* Unpacks the viewer, one script, and runs it. All elements with data are base64, most of it deflated. */
"use strict";
function packed(id) {
  const text = atob(document.getElementById(id).textContent), bytes = new Uint8Array(text.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = text.charCodeAt(i);
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

inflated("viewer").then(bytes => {
  const script = document.createElement("script");
  script.textContent = new TextDecoder().decode(bytes);
  document.body.append(script);
}).catch(() => {
  document.getElementById("summary").textContent = "DecompressionStream" in window
    ? "The page is damaged: its script cannot be unpacked."
    : "This browser cannot unpack the page, as it has no DecompressionStream. Browsers of 2023 and later have it.";
});
