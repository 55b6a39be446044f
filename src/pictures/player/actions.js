/* Sharing: a link, a command and a picture of this moment. */
let said = 0;

/* Shown for a while, and spoken. */
function say(text) {
  clearTimeout(said);
  ui.status.textContent = text;
  said = setTimeout(say, 4000, "");
}

/* Where the clipboard is refused, the text is in a field. */
async function copy(text, what) {
  try {
    await navigator.clipboard.writeText(text);
    say(what + " copied");
  } catch {
    ui.refused.hidden = false;
    ui.copied.value = text;
    ui.copied.select();
  }
}

/* As one word of a shell that is no option. */
function file_of({file, method}) {
  const name = (file ?? method.replace(/[/\0]/g, "_") + ".npz").replace(/^-/, "./-");
  return /^[\w./:=,+@%-]+$/.test(name) ? name : `'${name.replace(/'/g, "'\\''")}'`;
}

/* The commands that make the live runs. */
function simulations() {
  const quote = text => /^[\w./:=,+@%-]+$/.test(text) ? text : `'${text.replace(/'/g, "'\\''")}'`;
  const set = [...chosen].map(([name, value]) => ` --set ${name}=${value}`).join("");
  return live_runs().map(run =>
    `twinbox simulate ${quote(data.live.scene)}${set} --method ${quote(run.live)} -o ${file_of(run)} &&`);
}

ui["copy-link"].onclick = () => copy(location.href.split("#")[0] + link_text(), "Link");
/* Options that compare leave out the runs that cannot be compared. */
ui["copy-command"].onclick = () => {
  const {compare, show} = view, compares = compare !== "split" || show.has("ghosts") || show.has("distance");
  const options = [["frames", number_of(view.frame)], ...shown("camera"), ["theme", theme_name(), "light"]];
  copy([...simulations(), "twinbox render", ...runs.filter(run => run.compared || !compares).map(file_of), "-o frame",
    ...words("--", " ", options)].join(" "), "Command");
};
ui.copied.onblur = () => { ui.refused.hidden = true; };
ui.save.onclick = () => {
  draw();
  stage.toBlob(blob => {
    const href = URL.createObjectURL(blob);
    make("a", {href, download: `frame_${String(number_of(view.frame)).padStart(6, 0)}.png`}).click();
    setTimeout(() => URL.revokeObjectURL(href), 10000);
  });
};
