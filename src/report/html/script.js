'use strict';
(() => {
  const all = (selector, from = document) => [...from.querySelectorAll(selector)];

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
    const button = document.createElement('button');
    button.type = 'button';
    button.className = 'copy';
    button.textContent = 'Copy';
    button.addEventListener('click', () => copy(button));
    command.append(button);
  }

  const table = document.getElementById('table');
  const form = document.getElementById('filters');
  if (!table || !form) return;
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

  // Value of a row for each filter: an attribute of its own, or the column of that title.
  const titles = [...table.tHead.rows[0].cells].map((head) => head.textContent);
  const choices = all('select', form).map((select) => select.name);
  const own = (body, name) => body.dataset[name] ?? body.rows[0].cells[titles.indexOf(name)].textContent;
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

  // An address names a row, which is opened, or choices. A typed address may be neither.
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
    const body = named()?.closest('#table > tbody');
    if (!body) return;
    body.hidden = false;
    body.querySelector('details').open = true;
    body.scrollIntoView();
  };
  form.hidden = false;
  form.addEventListener('input', change);
  form.addEventListener('reset', () => setTimeout(change));
  form.addEventListener('submit', (event) => event.preventDefault());
  filter();
  addEventListener('hashchange', follow);
  follow();

  // Sorting: verdicts by severity, z by size, numbers by value, unknown values last; other columns by text.
  const severity = ['fail', 'inconclusive', 'undecided', 'underpowered', 'refused', 'pass'];
  const key = (body, column, isNumeric) => {
    const text = body.rows[0].cells[column].textContent;
    if (titles[column] === 'verdict') return String(severity.indexOf(body.dataset.verdict));
    if (!isNumeric) return text;
    const number = Number(text.replace(/[()]/g, '').replace('∞', 'Infinity'));
    return titles[column].startsWith('z of') ? Math.abs(number) : number;
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
    const button = document.createElement('button');
    button.type = 'button';
    button.append(...head.childNodes);
    button.addEventListener('click', () => sort(head, column, head.classList.contains('number')));
    head.append(button);
  });
})();
