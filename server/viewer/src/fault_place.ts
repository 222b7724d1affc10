// SPDX-License-Identifier: Apache-2.0
import type {Call, Fault} from './api';
import {isSameSystem, systemOf} from './placed';

const isPosition = (value: unknown): value is [number, number] =>
  Array.isArray(value) && value.length >= 2 && typeof value[0] === 'number' && typeof value[1] === 'number';

/**
 * Where a fault is in plan: its own coordinate, or what its pointer leads to in the body that was
 * sent. What was sent in another system than the terrain's has no place here.
 */
export function placeOf(fault: Fault, call: Call | null, terrain: string): number[] | undefined {
  let body: any = null;
  try {
    body = typeof call?.body === 'string' ? JSON.parse(call.body) : null;
  } catch {
    // Then it is the fault that it is no JSON.
  }
  const system = systemOf(body, call?.query?.crs ?? '');
  if (system && !isSameSystem(system, terrain)) return undefined;
  if (fault.coordinate || !fault.pointer) return fault.coordinate;
  let at = body;
  for (const name of fault.pointer.split('/').slice(1)) {
    const next = at?.[name.replaceAll('~1', '/').replaceAll('~0', '~')];
    // A pointer to a number of a position means the position.
    if (isPosition(at) && !isPosition(next)) break;
    at = next;
  }
  // A ring, or a geometry, is shown by where it begins.
  for (let deep = 0; deep < 6 && at && !isPosition(at); ++deep) at = Array.isArray(at) ? at[0] : at.geometry ?? at.coordinates;
  return isPosition(at) ? [at[0], at[1]] : undefined;
}
