/* Unpacks the viewer, one script, and runs it. All elements with data are base64, most of it deflated. */
"use strict";
function packed(id) {
  const text = atob(document.getElementById(id).textContent), bytes = new Uint8Array(text.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = text.charCodeAt(i);
  return bytes;
}

async function inflated(id) {
  const stream = new Blob([packed(id)]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

inflated("viewer").then(bytes => {
  const script = document.createElement("script");
  script.textContent = new TextDecoder().decode(bytes);
  document.body.append(script);
}).catch(() => {
  document.getElementById("summary").textContent = "DecompressionStream" in window
    ? "The page is damaged: its script cannot be unpacked."
    : "This browser cannot unpack the page, as it has no DecompressionStream. Browsers of 2023 and later have it.";
});
