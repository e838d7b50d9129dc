#include "live/page.hpp"

namespace bodeflow::tools::live {

const char* page_script() {
  return R"JS(
'use strict';
const kEvery = 500;                                   // ms between two looks
const token = location.hash.slice(1);
const by = id => document.getElementById(id);
const shown = new Map();                              // records: key -> {version, body}
const title = document.title;
let generation = -1;                                  // of what is drawn
let history = [];                                     // the looks of the last seconds: {generation, wall_s, firings}

function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}
function number(x, digits = 4) {
  return x === null || x === undefined || !isFinite(x) ? '–' : Number(x.toPrecision(digits)).toString();
}
function si(x, unit, digits = 4) {
  if (x === null || x === undefined || !isFinite(x)) return '–';
  const prefixes = ['p', 'n', 'µ', 'm', '', 'k', 'M', 'G', 'T'];
  const step = x === 0 ? 0 : Math.max(-4, Math.min(4, Math.floor(Math.log10(Math.abs(x)) / 3 + 1e-9)));
  return number(x / 1000 ** step, digits) + ' ' + prefixes[step + 4] + unit;
}
function text(value) {
  return Array.isArray(value) ? '[' + value.map(text).join(', ') + ']' : value === null ? 'none' : String(value);
}
function facts(list, pairs) {
  list.replaceChildren(...pairs.map(([name, value]) =>
    element('div', {}, element('dt', {}, name), element('dd', {}, value))));
}
function show(id, yes) { by(id).hidden = !yes; }
async function get(path) {
  const answer = await fetch(path, {cache: 'no-store'});
  if (!answer.ok) throw new Error(await answer.text());
  return answer;
}

function head(state) {
  by('title').textContent = state.title;
  const words = {running: 'running', complete: 'complete', partial: 'interrupted', failed: 'failed', limit: 'ended by a limit', starting: 'starting'};
  by('badge').textContent = state.status === 'complete' ? 'run complete' : words[state.status] || state.status;
  by('badge').className = 'badge ' + (state.status === 'limit' ? 'partial' : state.status);
  document.title = by('badge').textContent + ': ' + title;
  const phase = state.phase ? 'Phase ' + state.phase + (state.repeat > 0 ? ', repetition ' + (state.repeat + 1) : '') : '';
  by('where').textContent = [phase, state.directory].filter(Boolean).join(' · ');
  by('reason').textContent = state.reason;
  show('reason', state.reason !== '');
  const p = state.progress;
  if (!p) return;
  const share = p.total_s > 0 ? Math.min(1, p.time_s / p.total_s) : 0;
  by('progress').style.width = 100 * share + '%';
  const figures = state.sweep
    ? [['Runs of the sweep', number(p.time_s) + ' of ' + number(p.total_s)], ['What runs', 'each in a process of its own: seen here when all are done']]
    : [['Time of the run', si(p.time_s, 's') + (p.total_s > 0 ? ' of ' + si(p.total_s, 's') : '')],
       ['Its speed', number(p.rate) + ' s a second'], ['Clock', state.clock],
       ['Chunk', si(state.chunk_s, 's')], ['Overruns', String(state.overruns)]];
  if (state.skipped > 0) figures.push(['Chunks left out', String(state.skipped)]);
  facts(by('figures'), figures);
}

function measured(state, block) {                     // firings a second, over about three seconds
  const then = history[0];
  if (!then || then.generation !== state.generation || state.wall_s - then.wall_s < 0.4) return null;
  const rate = (state.blocks[block].firings - then.firings[block]) / (state.wall_s - then.wall_s);
  return isFinite(rate) ? rate : null;
}
function remember(state) {
  if (history.length > 0 && history[0].generation !== state.generation) history = [];
  if (state.blocks) history.push({generation: state.generation, wall_s: state.wall_s, firings: state.blocks.map(b => b.firings)});
  while (history.length > 1 && state.wall_s - history[1].wall_s > 3) history.shift();
}

async function graph(state) {
  if (state.generation !== generation) {
    by('graph').innerHTML = await (await get('/graph')).text();   // our own drawing: names are escaped
    generation = state.generation;
    parameters(state);
  }
  state.blocks.forEach((block, index) => {
    const notes = [], now = state.runs ? measured(state, index) : null;
    if (block.rate_hz !== undefined) notes.push(si(now === null ? block.rate_hz : now, 'Hz', 3));
    if (block.records > 0) notes.push(block.records + ' rec.');
    if (block.waiting > 0) notes.push(block.waiting + ' wait');
    for (const place of document.querySelectorAll('[data-block="' + index + '"]')) place.textContent = notes.join(' · ');
  });
}

function parameters(state) {
  show('parameters-section', state.parameters.length > 0);
  show('read-only', token === '');
  by('parameters').replaceChildren(...state.parameters.map((p, index) => {
    const name = p.block + '.' + p.parameter;
    const field = p.choices ? element('select', {'aria-label': name}, ...p.choices.map(c => element('option', {}, c)))
                            : element('input', {'aria-label': name, placeholder: text(p.value), autocomplete: 'off', spellcheck: 'false'});
    if (p.choices) field.value = text(p.value);
    const button = element('button', {type: 'submit'}, 'Set');
    const said = element('span', {class: 'said', role: 'status'});
    const form = element('form', {'data-parameter': name}, field, button);
    field.disabled = button.disabled = token === '';
    form.addEventListener('submit', event => {
      event.preventDefault();
      change(p, field.value, said);
    });
    const range = [p.form, p.range].filter(Boolean).join(', ');
    return element('tr', {}, element('td', {class: 'w s'}, element('b', {}, name), element('span', {class: 'caption', style: 'display:block'}, p.doc)),
      element('td', {'data-now': name}), element('td', {class: 'w s'}, form, element('span', {class: 'caption'}, range), said));
  }));
}

async function change(p, value, said) {
  const tell = (words, kind) => { said.textContent = words; said.className = 'said ' + kind; };
  try {
    const answer = await fetch('/change', {method: 'POST', cache: 'no-store',
      headers: {'Content-Type': 'application/json', 'X-Bodeflow-Token': token},
      body: JSON.stringify({generation, block: p.block, parameter: p.parameter, value})});
    const words = await answer.json();
    tell(answer.ok ? 'accepted: see Changes' : words.error, answer.ok ? 'good' : 'bad');
  } catch (error) {
    tell('not sent: ' + error.message, 'bad');
  }
}

function values(state) {
  for (const p of state.parameters) {
    const place = document.querySelector('[data-now="' + CSS.escape(p.block + '.' + p.parameter) + '"]');
    if (place) place.textContent = text(p.value) + (p.unit && p.value !== null ? ' ' + p.unit : '');
  }
}

function changes(state) {
  show('changes-section', state.changes.length > 0);
  by('changes').replaceChildren(...state.changes.map(c => element('tr', {class: c.status}, element('td', {}, c.block + '.' + c.parameter),
    element('td', {class: 'n'}, text(c.value)), element('td', {class: 'n'}, c.position === undefined ? '–' : String(c.position)),
    element('td', {class: 'n'}, c.time_s === undefined ? '–' : number(c.time_s, 7) + ' s'),
    element('td', {}, c.status === 'taken' ? 'in effect' : c.text))).reverse());
}

async function records(state) {
  show('records-section', state.records.length > 0);
  for (const record of state.records) {
    let place = shown.get(record.key);
    if (!place) {
      const line = element('p', {class: 'caption'}), body = element('div', {'data-record': record.key});
      by('records').append(element('h3', {}, record.key, ' ', element('span', {class: 'kind'}, record.kind)), line, body);
      shown.set(record.key, place = {version: 0, line, body});
    }
    place.line.textContent = (record.count > 1 ? 'record ' + record.count + ', ' : '') + 'at ' + si(record.time_s, 's');
    if (place.version === record.version) continue;
    const opened = [...place.body.querySelectorAll('details')].map(d => d.open);
    place.body.innerHTML = await (await get('/record?key=' + encodeURIComponent(record.key))).text();   // texts are escaped
    [...place.body.querySelectorAll('details')].forEach((d, n) => { d.open = opened[n] || false; });
    place.version = record.version;
  }
}

function wires(state) {
  const rows = state.streams.map(s => {
    const rate = s.block === undefined || !state.runs ? null : measured(state, s.block);
    const queue = s.ring ? [element('meter', {min: 0, max: s.ring.slots, value: s.ring.filled}), ' ' + s.ring.filled + ' of ' + s.ring.slots + ' chunks'] : s.block === undefined ? [] : ['same thread'];
    return element('tr', {}, element('td', {}, s.from), element('td', {}, s.to),
      element('td', {class: 'n'}, si(s.rate_hz, 'Hz') + (s.channels > 1 ? ' × ' + s.channels : '')),
      element('td', {class: 'n'}, rate === null ? '–' : si(rate * s.samples, 'Hz')), element('td', {}, ...queue));
  });
  for (const m of state.messages)
    rows.push(element('tr', {}, element('td', {}, m.from), element('td', {}, m.to), element('td', {class: 'n'}, 'records'),
      element('td', {class: 'n'}, m.count === undefined ? '–' : String(m.count)), element('td', {})));
  show('wires-section', rows.length > 0);
  by('wires').replaceChildren(...rows);
}

function lateness(state) {
  const late = state.lateness;
  show('lateness-section', Boolean(late));
  if (!late) return;
  by('lateness').textContent = late.chunks + ' chunks began late by ' + si(late.median_s, 's') + ' in the median, ' + si(late.p99_s, 's') +
    ' at 99 %, ' + si(late.max_s, 's') + ' at most.';
  const met = late.bins.map((count, k) => count > 0 ? k : -1).filter(k => k >= 0), most = Math.max(...late.bins);
  const name = k => k === 0 ? 'below 1 µs' : k === late.bins.length - 1 ? 'longer' : 'to ' + si(2 ** k * 1e-6, 's');
  const rows = [];
  for (let k = met[0]; k <= met[met.length - 1]; ++k)
    rows.push(element('span', {}, name(k)), element('span', {}, element('i', {style: 'width:' + 100 * late.bins[k] / most + '%'})),
      element('span', {}, String(late.bins[k])));
  by('bins').replaceChildren(...rows);
}

function log(state) {
  show('log-section', state.log.length > 0);
  by('log').replaceChildren(...state.log.map(m => element('li', {class: m.level}, element('b', {}, m.source), m.text)).reverse());
}

async function draw(state) {
  head(state);
  if (state.generation > 0) {
    await graph(state);
    values(state);
    wires(state);
    lateness(state);
  }
  changes(state);
  log(state);
  await records(state);
  remember(state);
}

async function look() {
  try {
    const state = await (await get('/state')).json();
    await draw(state);
    if (state.ended) {
      for (const field of document.querySelectorAll('form :is(input,select,button)')) field.disabled = true;
      document.documentElement.dataset.ended = state.status;
      await get('/state?key=seen');
      return;
    }
  } catch (error) {
    by('badge').className = 'badge failed';
    by('badge').textContent = 'no connection: the run has ended, or is stopped';
    document.documentElement.dataset.lost = error.message;
  }
  setTimeout(look, kEvery);
}
look();
)JS";
}

}  // namespace bodeflow::tools::live
