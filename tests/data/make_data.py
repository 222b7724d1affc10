# SPDX-License-Identifier: Apache-2.0
"""Makes the terrain and the polygons of this folder; see README.md.

    /usr/bin/python3 make_data.py [--dem jacksboro_fault_dem.npz] [--out FOLDER]

Needs Debian's python3-gdal, python3-numpy and python-matplotlib-data.
"""
import argparse
import heapq
import json
import math
import pathlib
import subprocess

import numpy as np
from osgeo import gdal, ogr, osr

gdal.UseExceptions()
ogr.UseExceptions()

EPSG = 32616        # UTM zone 16N
CELL = 83           # metres: the mean of the source's 74.7 m by 92.5 m
NO_DATA = -9999.0
HEIGHT_STEP = 128   # heights are whole multiples of 1/128 m, exact in Float32
SPACING = 1 / 1200  # the source's, degrees


def find_dem():
    listed = subprocess.run(["dpkg", "-L", "python-matplotlib-data"],
                            check=True, capture_output=True, text=True).stdout.split("\n")
    return next(path for path in listed if path.endswith("/jacksboro_fault_dem.npz"))


def warp(npz):
    """The source in UTM, as a raster in memory."""
    with np.load(npz) as source:
        heights = source["elevation"]
        west, north = float(source["xmin"]), float(source["ymax"])
        assert abs(float(source["dx"]) - SPACING) < 1e-12
    # Row 0 is the northern one and "ymax" is its upper edge. The file's "ymin" lies north of "ymax":
    # it is ymax + rows * dy where ymax - rows * dy was meant (README.md says how we know).
    rows, columns = heights.shape
    geographic = gdal.GetDriverByName("MEM").Create("", columns, rows, 1, gdal.GDT_Float32)
    geographic.SetGeoTransform((west, SPACING, 0, north, 0, -SPACING))
    geographic.SetProjection(srs(4326).ExportToWkt())
    geographic.GetRasterBand(1).WriteArray(heights.astype(np.float32))
    warped = gdal.Warp("", geographic, format="MEM", dstSRS=f"EPSG:{EPSG}", xRes=CELL, yRes=CELL,
                       targetAlignedPixels=True, resampleAlg="cubic", errorThreshold=0,
                       outputType=gdal.GDT_Float32, dstNodata=NO_DATA)
    band = warped.GetRasterBand(1)
    z = band.ReadAsArray().astype(np.float64)
    z = np.where(z == NO_DATA, NO_DATA, np.round(z * HEIGHT_STEP) / HEIGHT_STEP)
    band.WriteArray(z.astype(np.float32))
    return warped, z


def srs(code):
    reference = osr.SpatialReference()
    reference.ImportFromEPSG(code)
    reference.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    return reference


class Terrain:
    """Posts at the cells' centres."""

    def __init__(self, raster, z):
        self.raster, self.z, self.valid = raster, z, z != NO_DATA
        rows = self.valid[:-1] & self.valid[1:]
        self.cells = rows[:, :-1] & rows[:, 1:]
        transform = raster.GetGeoTransform()
        self.west, self.north = transform[0], transform[3]

    def place(self, x, y):
        """Column and row, in posts, as reals."""
        return (x - self.west) / CELL - 0.5, (self.north - y) / CELL - 0.5

    def point(self, column, row):
        return self.west + (column + 0.5) * CELL, self.north - (row + 0.5) * CELL

    def holds(self, x, y, margin=0):
        """Whether the point's cell, and those up to `margin` cells from it, have four valid posts each."""
        column, row = (math.floor(v) - margin for v in self.place(x, y))
        size = 2 * margin + 1
        if not (0 <= row <= self.cells.shape[0] - size and 0 <= column <= self.cells.shape[1] - size):
            return False
        return bool(self.cells[row:row + size, column:column + size].all())

    def on_edge(self, x, y, level):
        """Whether the point is the level's crossing of an edge between two valid neighbouring posts."""
        column, row = self.place(x, y)
        near_column, near_row = round(column), round(row)
        if abs(column - near_column) < 1e-9:
            ends = [(math.floor(row), near_column), (math.floor(row) + 1, near_column)]
            part = row - math.floor(row)
        elif abs(row - near_row) < 1e-9:
            ends = [(near_row, math.floor(column)), (near_row, math.floor(column) + 1)]
            part = column - math.floor(column)
        else:
            return False
        if not all(0 <= r < self.z.shape[0] and 0 <= c < self.z.shape[1] and self.valid[r, c] for r, c in ends):
            return False
        a, b = (self.z[r, c] for r, c in ends)
        return abs(a + part * (b - a) - level) < 1e-6


def contours(terrain):
    """(level, points) of the long contours whose vertices are on the grid's edges and clear of the outline;
    an open one's ends are cut back to such vertices.

    The levels are whole metres and 1/256 m: no post is on one, so no contour passes through a post.
    """
    z = terrain.z[terrain.valid]
    levels = [metre + 0.5 / HEIGHT_STEP for metre in range(math.ceil(z.min() / 5) * 5, math.floor(z.max()), 5)]
    layer_source = ogr.GetDriverByName("Memory").CreateDataSource("")
    layer = layer_source.CreateLayer("contours", srs(EPSG), ogr.wkbLineString)
    layer.CreateField(ogr.FieldDefn("level", ogr.OFTReal))
    gdal.ContourGenerate(terrain.raster.GetRasterBand(1), 0, 0, levels, 1, NO_DATA, layer, -1, 0)
    for feature in layer:
        level = round(feature.GetField("level") * 2 * HEIGHT_STEP) / (2 * HEIGHT_STEP)  # GDAL rounds the field
        points = [p[:2] for p in feature.GetGeometryRef().GetPoints()]
        points = [p for i, p in enumerate(points) if i == 0 or p != points[i - 1]]
        if not 300 < len(points) < 5000:
            continue
        good = [terrain.on_edge(*p, level) and terrain.holds(*p, margin=1) for p in points]
        if not any(good):
            continue
        kept = slice(good.index(True), len(good) - good[::-1].index(True))
        if all(good[kept]):
            yield level, points[kept]


def closest(found, segments, closed_only):
    """The contour with the nearest number of segments."""
    fit = [c for c in found if c[1][0] == c[1][-1] or not closed_only]
    return min(fit, key=lambda c: (abs(len(c[1]) - 1 - segments), c[0], c[1][0]))


def millimetres(points):
    return [(round(x, 3), round(y, 3)) for x, y in points]


def lake(centre, radius, segments):
    """A star-shaped outline: a circle with harmonics (amplitude, phase) on its logarithm."""
    harmonics = {2: (0.28, 0.9), 3: (0.17, 2.3), 4: (0.11, 4.1), 5: (0.09, 0.4), 7: (0.07, 5.2),
                 9: (0.05, 1.7), 12: (0.04, 3.3), 17: (0.03, 2.6)}
    ring = []
    for i in range(segments):
        angle = math.tau * i / segments
        r = radius * math.exp(sum(a * math.sin(k * angle + phase) for k, (a, phase) in harmonics.items()))
        ring.append((centre[0] + r * math.cos(angle), centre[1] + r * math.sin(angle)))
    return millimetres(ring + ring[:1])


def road(terrain, start, end, count):
    """The way of least effort from start to end over every third post, smoothed, as `count` points."""
    step = 3
    z, valid = terrain.z[::step, ::step], terrain.valid[::step, ::step]
    place = [tuple(round(v / step) for v in reversed(terrain.place(*p))) for p in (start, end)]
    best, back, queue = {place[0]: 0.0}, {}, [(0.0, place[0])]
    while queue:
        effort, here = heapq.heappop(queue)
        if here == place[1]:
            break
        if effort > best[here]:
            continue
        for dr in (-1, 0, 1):
            for dc in (-1, 0, 1):
                r, c = here[0] + dr, here[1] + dc
                if (dr, dc) == (0, 0) or not (0 <= r < z.shape[0] and 0 <= c < z.shape[1] and valid[r, c]):
                    continue
                length = step * CELL * math.sqrt(dr * dr + dc * dc)
                slope = (z[r, c] - z[here]) / length
                total = effort + length * (1 + (slope / 0.04) ** 2)
                if total < best.get((r, c), math.inf):
                    best[r, c], back[r, c] = total, here
                    heapq.heappush(queue, (total, (r, c)))
    line = [place[1]]
    while line[-1] != place[0]:
        line.append(back[line[-1]])
    line = np.array([terrain.point(step * c, step * r) for r, c in reversed(line)])
    line += (17.3, 9.1)  # off the posts and the cells' diagonals
    for _ in range(3):
        line[1:-1] = (line[:-2] + 2 * line[1:-1] + line[2:]) / 4
    along = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    at = np.linspace(0, along[-1], count)
    return millimetres(zip(np.interp(at, along, line[:, 0]).tolist(), np.interp(at, along, line[:, 1]).tolist()))


def ring_at(centre, offsets):
    ring = millimetres((centre[0] + x, centre[1] + y) for x, y in offsets)
    return ring + ring[:1]


def wound(ring, counter_clockwise):
    x0, y0 = ring[0]
    area = sum((a[0] - x0) * (b[1] - y0) - (b[0] - x0) * (a[1] - y0) for a, b in zip(ring, ring[1:]))
    return ring if (area > 0) == counter_clockwise else ring[::-1]


def write(folder, name, kind, parts, **properties):
    """parts: a line's points, or a polygon's rings with the outer one first."""
    if kind == "Polygon":
        parts = [wound(ring, i == 0) for i, ring in enumerate(parts)]
    geometry = {"type": kind, "coordinates": parts}
    shape = ogr.CreateGeometryFromJson(json.dumps(geometry))
    assert shape.IsValid() and shape.IsSimple(), name
    collection = {
        "type": "FeatureCollection",
        "name": name,
        "crs": {"type": "name", "properties": {"name": f"urn:ogc:def:crs:EPSG::{EPSG}"}},
        "features": [{"type": "Feature", "properties": {"name": name, **properties}, "geometry": geometry}],
    }
    text = json.dumps(collection).replace("]], [[", "]],\n[[").replace("], [", "],\n[")
    (folder / f"{name}.geojson").write_text(text + "\n", encoding="ascii")
    for i, points in enumerate([parts] if kind == "LineString" else parts):
        shortest = min(math.dist(a, b) for a, b in zip(points, points[1:]))
        closed = "closed" if points[0] == points[-1] else "open"
        print(f"{name}.geojson: {kind} part {i}, {len(points) - 1} segments, {closed}, "
              f"shortest {shortest:.4f} m, {properties}")


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--dem", help="jacksboro_fault_dem.npz (else the Debian package's)")
    arguments.add_argument("--out", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent)
    given = arguments.parse_args()
    folder = given.out

    raster, z = warp(given.dem or find_dem())
    terrain = Terrain(raster, z)
    # NUM_THREADS is left alone and nothing dates the file, so that its bytes are the same every time.
    gdal.GetDriverByName("GTiff").CreateCopy(
        str(folder / "jacksboro.tif"), raster,
        options=["COMPRESS=DEFLATE", "PREDICTOR=3", "ZLEVEL=9", "TILED=YES"]).FlushCache()
    print(f"jacksboro.tif: {z.shape[1]} x {z.shape[0]} posts, {terrain.valid.sum()} valid, "
          f"{2 * terrain.cells.sum()} triangles, heights {z[terrain.valid].min()} to {z[terrain.valid].max()} m")

    outline = lake(centre=(756300.0, 4026200.0), radius=1500.0, segments=90)
    way = road(terrain, start=(734000.0, 4035500.0), end=(761500.0, 4008500.0), count=60)
    parcel_centre = (748431.0, 4022817.0)
    outer = ring_at(parcel_centre, [(-243.417, -187.902), (-61.338, -214.551), (48.274, -171.036), (187.663, -196.218),
                                    (251.109, -42.774), (214.886, 61.493), (262.331, 168.057), (91.742, 221.369),
                                    (33.518, 174.926), (-118.207, 208.613), (-229.854, 117.381), (-197.126, -23.649)])
    hole = ring_at(parcel_centre, [(-88.213, -71.447), (41.906, -94.318), (97.551, 18.264), (12.379, 86.731),
                                   (-79.642, 39.187)])
    for points in (outline, way, outer, hole):
        assert all(terrain.holds(*p) for p in points)

    # Over the north-western corner: through the valid posts, the no-data wedge and beyond the raster.
    leaving = ring_at((terrain.west, terrain.north), [(3517.283, -4211.619), (5206.774, -2817.335), (6913.402, 611.258),
                                                      (3104.917, 1408.553), (-1207.341, 1613.884),
                                                      (-1519.226, -2304.471), (611.837, -3618.129)])
    within = [terrain.holds(*p) for p in leaving]
    assert any(within) and not all(within)

    write(folder, "lake", "Polygon", [outline])
    write(folder, "road", "LineString", way)
    write(folder, "parcel", "Polygon", [outer, hole])
    write(folder, "leaving", "Polygon", [leaving])
    found = list(contours(terrain))
    for segments, closed_only in ((450, True), (3500, False)):
        level, points = closest(found, segments, closed_only)
        closed = points[0] == points[-1]
        write(folder, f"contour_{segments}", "Polygon" if closed else "LineString",
              [points] if closed else points, level=level)


if __name__ == "__main__":
    main()
