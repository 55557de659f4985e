"""A skin compared with the one that it was made from."""
from __future__ import annotations

import ctypes
from dataclasses import dataclass
from typing import Optional

import numpy as np

from .abi import abi
from .arrays import copy
from .character import Character

_SEVERITIES = ('note', 'warning', 'error')
_EVIDENCE = ('exact', 'certified', 'sampled', 'not_tested')


@dataclass(frozen=True)
class Finding:
    """One kind of fault over all vertices that have it. mesh, vertex and bone name the worst place, of the target;
    docs/validation_codes.md lists the codes."""
    code: str
    severity: str
    evidence: str
    text: str
    advice: str
    value: float
    threshold: float
    unit: str
    count: int
    mesh: Optional[int]
    vertex: Optional[int]
    bone: Optional[int]


@dataclass(frozen=True)
class Report:
    """findings: errors first. Lengths in metres: the diagonal of the source, the largest deviation in the poses that were tried
    (`sampled`) and that a search found (`found`), and `certified`, which no certified vertex exceeds in any pose within the joint
    limits. vertex_deviation, vertex_bound: per vertex of the target, all meshes one after the other; NaN: no match, or no bound."""
    findings: list
    diagonal: float
    sampled: float
    found: float
    certified: float
    pose_count: int
    unmatched: int
    uncertified: int
    vertex_deviation: np.ndarray
    vertex_bound: np.ndarray

    @property
    def passes(self) -> bool:
        """No finding is an error."""
        return all(finding.severity != 'error' for finding in self.findings)


def validate(source: Character, target: Character, **options) -> Report:
    """Compares the skin of a target with that of its source. Options are fields of sunder_validation_options: random_poses,
    random_angle, seed, maximum_deviation, error_deviation, has_clip_limits, clip_margin. O(vertices x poses)."""
    raw = abi.new('validation_options', **options)
    handle = abi.output('validate', source._handle, target._handle, ctypes.byref(raw))
    try:
        info = abi.new('report_info')
        abi.call('get_report', handle, ctypes.byref(info))
        findings, count = ctypes.POINTER(abi.type('finding'))(), ctypes.c_uint32()
        abi.call('get_findings', handle, ctypes.byref(findings), ctypes.byref(count))
        deviations, bounds, vertices = ctypes.POINTER(ctypes.c_float)(), ctypes.POINTER(ctypes.c_float)(), ctypes.c_uint32()
        abi.call('get_vertex_deviations', handle, ctypes.byref(deviations), ctypes.byref(bounds), ctypes.byref(vertices))
        return Report(
            [_finding(findings[i]) for i in range(count.value)], info.diagonal, info.sampled, info.found, info.certified,
            info.pose_count, info.unmatched, info.uncertified, copy(deviations, vertices.value), copy(bounds, vertices.value))
    finally:
        abi.call('destroy_report', handle)


def _finding(raw) -> Finding:
    def index(number):
        return None if number == abi.constant('NONE') else number

    return Finding(raw.code.decode(), _SEVERITIES[raw.severity], _EVIDENCE[raw.evidence], raw.text.decode('utf-8', 'replace'),
                   raw.advice.decode(), raw.value, raw.threshold, raw.unit.decode(), raw.count, index(raw.mesh), index(raw.vertex),
                   index(raw.bone))
