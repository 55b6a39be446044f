/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What access.py and regression/page run in the page before its own script: how large and how clear text is (WCAG 2.2 AA:
   contrast 4.5, of large text 3), in elements and on canvases. On a canvas the colour behind a text is what is there when
   it is drawn. */
"use strict";
window.audit = (() => {
  const SMALLEST = 12; /* px */
  const channels = colour => {
    const hex = /^#([0-9a-f]{6})([0-9a-f]{2})?$/i.exec(colour);
    if (!hex) return colour.match(/[\d.]+/g).map(Number);
    return [0, 2, 4].map(i => parseInt(hex[1].slice(i, i + 2), 16)).concat(hex[2] ? parseInt(hex[2], 16) / 255 : 1);
  };
  const over = ([r, g, b, alpha = 1], [R, G, B]) =>
    [r * alpha + R * (1 - alpha), g * alpha + G * (1 - alpha), b * alpha + B * (1 - alpha)];
  const luminance = colour => {
    const [r, g, b] = colour.map(c => c / 255).map(c => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const ratio = (a, b) => {
    const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y);
    return (high + 0.05) / (low + 0.05);
  };
  /* What is behind an element's text; white behind the document. */
  const ground = e => {
    if (e === null) return [255, 255, 255];
    const colour = channels(getComputedStyle(e).backgroundColor);
    return colour.length === 3 ? colour : over(colour, ground(e.parentElement));
  };
  const least = (size, bold) => size >= 24 || (size >= 18.66 && bold) ? 3 : 4.5;
  const words = e => (e.id ? e.textContent : e.ariaLabel ?? e.labels?.[0]?.textContent ?? e.textContent).trim().slice(0, 30);
  const name = e => e.tagName.toLowerCase() + (e.id && "#" + e.id) + " '" + words(e) + "'";
  const visible = e => e.getClientRects().length > 0 && getComputedStyle(e).visibility === "visible";

  const fault_of = (what, size, colour, behind, limit) => {
    const found = ratio(over(colour, behind), behind);
    const pair = [colour, behind].map(channels => channels.map(Math.round)).join(" on ");
    if (!(found >= limit - 0.005)) return `${what}: contrast ${found.toFixed(2)}, ${pair}`;
    return size >= SMALLEST - 0.01 ? "" : `${what}: ${size.toFixed(1)} px`;
  };

  /* Texts of canvases, as they are drawn. */
  const drawn = [];
  const median = (pixels, channel) => {
    const found = [];
    for (let i = channel; i < pixels.length; i += 4) found.push(pixels[i]);
    return found.sort((a, b) => a - b)[found.length >> 1];
  };
  const behind_text = (context, text, x, y) => {
    const m = context.measureText(text), turn = context.getTransform();
    const places = [-m.actualBoundingBoxLeft, m.actualBoundingBoxRight].flatMap(dx =>
      [-m.actualBoundingBoxAscent, m.actualBoundingBoxDescent].map(dy => turn.transformPoint({x: x + dx, y: y + dy})));
    const [left, right] = [Math.min, Math.max].map(f => Math.round(f(...places.map(p => p.x))));
    const [top, bottom] = [Math.min, Math.max].map(f => Math.round(f(...places.map(p => p.y))));
    const {data} = context.getImageData(left, top, Math.max(1, right - left), Math.max(1, bottom - top));
    const [r, g, b, alpha] = [0, 1, 2, 3].map(channel => median(data, channel));
    return over([r, g, b, alpha / 255], ground(context.canvas.isConnected ? context.canvas : document.body));
  };
  for (const kind of ["fillText", "strokeText"]) {
    const draw = CanvasRenderingContext2D.prototype[kind];
    CanvasRenderingContext2D.prototype[kind] = function (text, x, y, ...rest) {
      if (kind === "fillText" && String(text).trim() !== "") {
        const {a, b} = this.getTransform(), pixels = parseFloat(/([\d.]+)px/.exec(this.font)[1]);
        const size = pixels * Math.hypot(a, b) / devicePixelRatio, limit = least(size, /bold|[6-9]00/.test(this.font));
        const colour = typeof this.fillStyle === "string" ? channels(this.fillStyle) : [0, 0, 0];
        const behind = behind_text(this, String(text), x, y);
        drawn.push({text: String(text), fault: fault_of(`${this.canvas.id} "${text}"`, size, colour, behind, limit)});
      }
      return draw.call(this, text, x, y, ...rest);
    };
  }

  const all = selector => [...document.querySelectorAll(selector)];
  const elements = () => all("body *").filter(e => visible(e) && !e.closest("script, style, option, canvas") &&
    [...e.childNodes].some(n => n.nodeType === Node.TEXT_NODE && n.textContent.trim()));
  const controls = () => all("a[href], button, input, select, textarea, summary, [tabindex='0']").filter(e =>
    !e.disabled && visible(e));
  return {
    drawn, name,
    text: () => ({count: elements().length, faults: elements().filter(e => !e.closest(":disabled")).map(e => {
      const style = getComputedStyle(e), size = parseFloat(style.fontSize);
      const colour = e instanceof SVGElement ? style.fill : style.color;
      return fault_of(name(e), size, channels(colour), ground(e), least(size, Number(style.fontWeight) >= 700));
    }).filter(Boolean)}),
    ids: () => all("[id]").map(e => e.id).filter((id, i, all) => all.indexOf(id) !== i),
    /* Pictures that are not for decoration are images with a name. */
    pictures: () => all("canvas, svg, img").filter(e => visible(e) && !e.closest("[aria-hidden=true]") &&
      !(e.getAttribute("role") === "img" && (e.getAttribute("aria-label") ?? "").length > 3)).map(name),
    /* One stop for each control, and one for each group of radio buttons. */
    stops: () => controls().filter(e => e.type !== "radio" || e.checked).map(name),
    focused: () => {
      const e = document.activeElement, style = e && getComputedStyle(e);
      if (e === null || e === document.body) return null;
      const outlined = style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 1;
      return {name: name(e), ring: outlined || style.boxShadow !== "none"};
    },
    /* 2.5.8; the marks on the time axis stand in a list, too. */
    small: () => controls().filter(e => !e.closest("#marks")).filter(e => {
      const boxes = [e, ...e.labels ?? []].map(part => part.getBoundingClientRect());
      return !boxes.some(b => b.width >= 24 && b.height >= 24);
    }).map(e => `${name(e)}: ${e.clientWidth} x ${e.clientHeight} px`),
    wide: () => {
      const {scrollWidth, clientWidth} = document.documentElement;
      const beyond = all("body *").filter(e => e.getBoundingClientRect().right > clientWidth + 1);
      return scrollWidth > clientWidth ? [`${scrollWidth} of ${clientWidth} px`, ...beyond.map(name)] : [];
    },
  };
})();
