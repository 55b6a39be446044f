"use strict";
/* A still becomes the page that it is of, where its reader asks for it. Without this script it is a link. */
for (const figure of document.querySelectorAll(".live")) {
  const button = document.createElement("button"), still = figure.querySelector("a");
  button.className = "play";
  button.type = "button";
  button.textContent = "Try it here";
  button.onclick = () => {
    const frame = document.createElement("iframe");
    frame.src = still.href.replace("#", "#stage&"); /* controls on demand */
    frame.title = figure.dataset.title;
    still.style.display = "none"; /* printed instead */
    still.after(frame);
    button.remove();
    frame.scrollIntoView({block: "nearest"});
    frame.focus();
  };
  still.after(button);
}
