'use strict';
(() => {
  const all = (selector, from = document) => [...from.querySelectorAll(selector)];
  const add = (name, className) => {
    const one = document.createElement(name);
    one.className = className;
    return one;
  };

  // Copying: without access to the clipboard the command is selected for the reader to copy.
  const copy = async (button) => {
    const code = button.parentElement.querySelector('code');
    try {
      await navigator.clipboard.writeText(code.textContent);
      button.textContent = 'Copied';
    } catch {
      getSelection().selectAllChildren(code);
      button.textContent = 'Selected';
    }
    setTimeout(() => { button.textContent = 'Copy'; }, 2000);
  };
  for (const command of all('.command')) {
    const button = add('button', 'copy');
    button.type = 'button';
    button.textContent = 'Copy';
    button.addEventListener('click', () => copy(button));
    command.append(button);
  }

  // One bubble for all explanations and values, at a point of the window; a ring marks the point of a plot.
  const bubble = document.body.appendChild(add('div', 'tip'));
  const ring = document.body.appendChild(add('div', 'spot'));
  bubble.setAttribute('role', 'status');
  const hide = () => { bubble.hidden = ring.hidden = true; };
  const say = (text, x, y, isPoint) => {
    bubble.textContent = text;
    bubble.hidden = false;
    ring.hidden = !isPoint;
    const { width, height } = bubble.getBoundingClientRect();
    const left = Math.max(4, Math.min(x + 12, document.documentElement.clientWidth - width - 4));
    const top = y + 16 + height > innerHeight ? y - height - 12 : y + 16;
    bubble.style.left = `${left + scrollX}px`;
    bubble.style.top = `${top + scrollY}px`;
    ring.style.left = `${x + scrollX}px`;
    ring.style.top = `${y + scrollY}px`;
  };
  hide();

  // Explanations appear on focus, too; a title of the browser's own would appear beside them.
  const explained = (target) => target.closest?.('[data-tip]');
  const explain = (one) => {
    const { left, bottom } = one.getBoundingClientRect();
    say(one.dataset.tip, left, bottom - 12);
  };
  const takeTitles = () => {
    for (const one of all('[title]')) {
      one.dataset.tip = one.title;
      if (one.matches('a.cell')) one.setAttribute('aria-label', one.title);
      one.removeAttribute('title');
    }
  };
  addEventListener('pointerover', (event) => {
    const one = explained(event.target);
    if (one) explain(one);
    else if (!event.target.closest?.('.plot, [data-view]')) hide();
  });
  addEventListener('focusin', (event) => {
    const one = explained(event.target);
    if (one && event.target.matches(':focus-visible')) explain(one);
    else hide();
  });
  addEventListener('keydown', (event) => { if (event.key === 'Escape') hide(); });

  // Values of plots: that of the nearest point under the pointer, or one after another by the arrow keys.
  const points = new Map();
  // Small plots have no values of their own: those of their lines follow from the range in `data-view`.
  const looks = (svg) => {
    const [x0, x1, y0, y1, kind] = svg.dataset.view.split(' ');
    const names = all('figcaption span', svg.parentElement).map((name) => name.textContent.trim());
    return all('path:not(.mark, .limit)', svg).flatMap((path, line) => {
      const way = path.getAttribute('d').match(/-?\d+/g).map(Number);
      const places = [];
      let [x, y] = [0, 0];
      for (let i = 0; i < way.length; i += 2) {
        [x, y] = [x + way[i], y + way[i + 1]];
        const across = Number(x0) + (x1 - x0) * x / 400;
        const up = Number(y0) + (y1 - y0) * (1 - y / 120);
        const text = kind === 'draws'
          ? `${names[line]}: ln E at ${up.toFixed(2)} of its limit after ${Math.round(10 ** across)} draws`
          : `${names[line]}: ${up.toPrecision(3)} at t = ${across.toPrecision(3)}`;
        places.push({ x, y, text });
      }
      return places;
    });
  };
  const pointsOf = (svg) => {
    if (svg.dataset.view) return looks(svg);
    const use = svg.querySelector('use');
    const source = use ? document.getElementById(use.getAttribute('href').slice(1)) : svg;
    if (!points.has(source)) {
      points.set(source, (source.dataset.tips ?? '').split('\n').filter(Boolean).map((line) => {
        const [, x, y, text] = line.match(/^(\S+) (\S+) (.*)$/);
        return { x: Number(x), y: Number(y), text };
      }));
    }
    return points.get(source);
  };
  const placed = (svg) => {
    const matrix = svg.getScreenCTM();
    return pointsOf(svg).map(({ x, y, text }) => ({ text, at: new DOMPoint(x, y).matrixTransform(matrix) }));
  };
  const NEAR = 24;
  for (const svg of all('svg.plot, svg[data-view]')) {
    svg.addEventListener('pointermove', ({ clientX, clientY }) => {
      const near = placed(svg).map((point) => ({ ...point, far: Math.hypot(point.at.x - clientX, point.at.y - clientY) }))
        .reduce((a, b) => (b.far < a.far ? b : a), { far: NEAR });
      if (near.at) say(near.text, near.at.x, near.at.y, true);
      else hide();
    });
    svg.addEventListener('pointerleave', hide);
    const holder = svg.parentElement;
    holder.tabIndex = 0;
    holder.setAttribute('aria-label', 'plot; arrow keys read its values');
    let place = -1;
    holder.addEventListener('keydown', (event) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      const values = step ? placed(svg) : [];
      if (event.target !== holder || values.length === 0) return;
      event.preventDefault();
      place = (Math.max(place, step < 0 ? 0 : -1) + step + values.length) % values.length;
      say(values[place].text, values[place].at.x, values[place].at.y, true);
    });
  }

  // One stop of the tabulator for the map; arrows go from cell to cell.
  const cells = all('.map a.cell');
  cells.forEach((cell, place) => { cell.tabIndex = place === 0 ? 0 : -1; });
  const go = (from, to) => {
    if (!to) return;
    from.tabIndex = -1;
    to.tabIndex = 0;
    to.focus();
  };
  document.querySelector('.map')?.addEventListener('keydown', (event) => {
    const place = cells.indexOf(event.target);
    const near = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (place < 0) return;
    if (near) {
      event.preventDefault();
      go(event.target, cells[place + near]);
    } else if (event.key === 'ArrowDown' || event.key === 'ArrowUp') {
      event.preventDefault();
      const lines = all('.map .cells').filter((line) => line.querySelector('a'));
      const line = event.target.parentElement;
      const column = [...line.children].indexOf(event.target);
      const next = lines[lines.indexOf(line) + (event.key === 'ArrowDown' ? 1 : -1)];
      go(event.target, next && (next.children[column] ?? next.lastElementChild));
    }
  });

  const table = document.getElementById('table');
  const form = document.getElementById('filters');
  if (!table || !form) {
    takeTitles();
    return;
  }
  const bodies = all('#table > tbody');
  const said = (body) => body.rows[0].textContent + ' ' + (body.querySelector('.reason')?.textContent ?? '');
  const words = new Map(bodies.map((body) => [body, said(body).toLowerCase()]));

  // A row opens by a click on any of its cells, but not where words are being selected.
  for (const body of bodies) {
    body.rows[0].addEventListener('click', (event) => {
      if (event.target.closest('summary, a, button') || !getSelection().isCollapsed) return;
      const details = body.querySelector('details');
      if (details) details.open = !details.open;
    });
  }

  // Value of a row for each filter: an attribute of its own, or of its case.
  const choices = all('select', form).map((select) => select.name);
  const own = (body, name) => body.dataset[name] ?? document.getElementById(`case-${body.dataset.case}`).dataset[name];
  const values = new Map(bodies.map((body) => [body, choices.map((name) => '=' + own(body, name))]));

  // A choice begins with `=`, so that an empty name is not taken for all. Choices are in the address and, on paper,
  // above the table.
  const filter = () => {
    const wanted = [...new FormData(form)].filter(([, value]) => value);
    const texts = form.elements.text.value.toLowerCase().split(/\s+/);
    let shown = 0;
    for (const body of bodies) {
      const own = values.get(body);
      const fits = choices.every((name, place) => !form.elements[name].value || form.elements[name].value === own[place]);
      body.hidden = !(fits && texts.every((text) => words.get(body).includes(text)));
      shown += body.hidden ? 0 : 1;
    }
    const count = `${shown} of ${bodies.length}`;
    document.getElementById('shown').textContent = count;
    document.getElementById('none').hidden = shown > 0;
    const said = wanted.map(([name, value]) => `${name} ${value.replace(/^=/, '')}`).join(', ');
    document.getElementById('chosen').textContent = said && `${count}: ${said}`;
    return wanted;
  };
  const change = () => {
    const wanted = filter();
    history.replaceState(null, '', wanted.length > 0 ? `#?${new URLSearchParams(wanted)}` : '#experiments');
  };

  // An address names a row or a case, which is opened, or choices. A typed address may be neither.
  const named = () => {
    try {
      return document.getElementById(decodeURIComponent(location.hash.slice(1)));
    } catch {
      return null;
    }
  };
  const follow = () => {
    if (location.hash.startsWith('#?')) {
      form.reset();
      for (const [field, value] of new URLSearchParams(location.hash.slice(2))) {
        if (form.elements[field]) form.elements[field].value = value;
      }
      filter();
      form.scrollIntoView();
      return;
    }
    const one = named()?.closest('#table > tbody, details.case');
    if (!one) return;
    one.hidden = false;
    (one.matches('details') ? one : one.querySelector('details')).open = true;
    one.scrollIntoView();
  };
  form.hidden = false;
  form.addEventListener('input', change);
  form.addEventListener('reset', () => setTimeout(change));
  form.addEventListener('submit', (event) => event.preventDefault());
  filter();
  addEventListener('hashchange', follow);
  // A second click on the same link.
  addEventListener('click', (event) => { if (event.target.closest('a.cell, a.of')) setTimeout(follow); });
  follow();

  // Sorting: verdicts by severity, z by its size, numbers by value, unknown values last; other columns by text.
  const titles = [...table.tHead.rows[0].cells].map((head) => head.textContent);
  const severity = ['fail', 'inconclusive', 'undecided', 'underpowered', 'refused', 'pass'];
  const key = (body, column, isNumeric) => {
    const text = body.rows[0].cells[column].textContent;
    if (titles[column] === 'verdict') return String(severity.indexOf(body.dataset.verdict));
    if (!isNumeric) return text;
    const number = Number(text.replace(/[()%\s]/g, '').replace('∞', 'Infinity'));
    return titles[column].startsWith('z') ? Math.abs(number) : number;
  };
  const collator = new Intl.Collator('en', { numeric: true });
  const sort = (head, column, isNumeric) => {
    const sign = head.getAttribute('aria-sort') === 'ascending' ? -1 : 1;
    for (const other of head.parentElement.cells) other.removeAttribute('aria-sort');
    head.setAttribute('aria-sort', sign > 0 ? 'ascending' : 'descending');
    const keys = new Map(bodies.map((body) => [body, key(body, column, isNumeric)]));
    const order = [...bodies].sort((one, other) => {
      const [a, b] = [keys.get(one), keys.get(other)];
      if (!isNumeric) return sign * collator.compare(a, b);
      return Number.isNaN(a) || Number.isNaN(b) ? Number.isNaN(a) - Number.isNaN(b) : sign * (a - b);
    });
    table.append(...order);
  };
  [...table.tHead.rows[0].cells].forEach((head, column) => {
    const button = add('button', '');
    button.type = 'button';
    button.append(...head.childNodes);
    button.title = head.title;
    head.removeAttribute('title');
    button.addEventListener('click', () => sort(head, column, head.classList.contains('number')));
    head.append(button);
  });
  takeTitles();
})();
