// SPDX-License-Identifier: Apache-2.0
import type {Call, Fault} from './api';
import {isSameSystem, systemOf} from './placed';

/** Where a fault is on the terrain. Faults speak of what was sent: in another system that is no place here. */
export function placeOf(fault: Fault, call: Call | null, terrain: string): number[] | undefined {
  if (!fault.coordinate) return undefined;
  let body: unknown = null;
  try {
    body = typeof call?.body === 'string' ? JSON.parse(call.body) : null;
  } catch {
    // Then it is the fault that it is no JSON.
  }
  const system = systemOf(body, call?.query?.crs ?? '');
  return system && !isSameSystem(system, terrain) ? undefined : fault.coordinate;
}
