/* Sharing: a link, a command and a picture of this moment. */
let said = 0;

/* Shown for a while, and spoken. */
function say(text) {
  clearTimeout(said);
  ui.status.textContent = text;
  said = setTimeout(say, 4000, "");
}

/* Where the clipboard is refused, the text is in a field. */
async function copy(text, what, but = "") {
  try {
    await navigator.clipboard.writeText(text);
    say(`${what} copied${but}`);
  } catch {
    ui.refused.hidden = false;
    ui.copied.value = text;
    ui.copied.select();
  }
}

/* One word of a shell; one that is no option. Pasted, an end of a line could begin a command of its own: no control character
   passes, nor one that turns the direction of text. */
const plain = text => text.replace(/[\p{Cc}\p{Cf}\p{Zl}\p{Zp}]/gu, " ");
const quote = text => /^[\w./:=,+@%-]+$/.test(text) ? text : `'${plain(text).replace(/'/g, "'\\''")}'`;
const word = text => quote(text.replace(/^-/, "./-"));
const file_of = ({file, method}) => word(file ?? method.replace(/[/\0]/g, "_") + ".npz");

/* Names that the page's author gave. */
const given_name = ({caption, name}) => name === caption ? caption : "";
const captions_of = all => all.some(given_name) ? all.map(run => ` --caption ${quote(given_name(run))}`).join("") : "";

/* The command that makes a run of a scene; "" for a run that is a file. */
function simulation(run) {
  const set = (run.live ? set_text() : data.set).split(",").filter(Boolean).map(part => `--set ${word(part)} `).join("");
  return run.made_of ? `twinbox simulate ${word(run.made_of)} ${set}--method ${word(run.method)} -o ${file_of(run)} && ` : "";
}

/* Beside live panels a command of its own makes each run. That leaves out files, which only the page's author has; a run of another
   launch; and programs of others, as a page must not name what a pasted line starts. */
const is_left_out = run => data.live && (!run.made_of || run.elsewhere || /^\s*exec/.test(run.method));

ui["copy-link"].onclick = () => copy(location.href.split("#")[0] + link_text(), "Link");
/* Options that compare leave out the runs that cannot be compared, too. */
ui["copy-command"].onclick = () => {
  const compares = view.compare !== "split" || [...view.show].some(look => data.shows[look] === "others");
  const options = [["frames", number_of(view.frame)], ...shown("camera"), ["theme", theme_name(), "light"]];
  const found = runs.filter(run => !is_left_out(run) && (run.compared || !compares)), left = runs.filter(run => !found.includes(run));
  copy([...new Set(found.map(simulation)), "twinbox render ", found.map(file_of).join(" "), " -o frame ",
    words("--", " ", options).join(" "), captions_of(found)].join(""), "Command", left.length > 0 ? `, without ${left.map(({name}) => name).join(", ")}` : "");
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
