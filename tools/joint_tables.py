#!/usr/bin/env python3
"""Makes the shipped tables of ligaments and discs from the full ones: tools/joint_tables.py FOLDER data/anatomy/joints

FOLDER holds joints_ligaments.csv and bones/discs.csv. What changes on the way:
- every stiffness becomes a slope [N/mm], or two and the strain where they change, so that one law reads all rows;
- the lumbar ligaments get the bilinear force and elongation of one table that has moduli, areas and lengths
  (PMC2913991 Table 3): k = E A / L with all three of it, the same at each level; the distance of our attachments is no
  length for it, half of it for some. Its flavum is the whole, a row one half of it. The capsules, which it lacks, have
  the moduli of PMC5592017 Table 2, whose other moduli are the same, and 30 mm2 a side;
- capsules of the facets lose their attachments: the source took the tips of wrong processes at several levels, the
  program finds the joint on the bones themselves;
- lengths follow the bones that data/anatomy/assembly.csv has elsewhere than the full table (forearm and hand): each changes as
  the distance of its ends does;
- strands: as many as the ligament is broad; discs: the height that literature states for the level.
"""
import csv
import math
import pathlib
import sys

# E1 [MPa], strain, E2 [MPa], area [mm2] of one row, length [mm] of the lumbar ligaments
LUMBAR = {"ALL": (7.8, 0.12, 20.0, 53.0, 13.0), "PLL": (10.0, 0.11, 50.0, 16.0, 11.0),
          "LF": (15.0, 0.062, 19.5, 33.5, 19.0), "ITL": (10.0, 0.18, 59.0, 1.8, 22.0),
          "ISL": (10.0, 0.14, 11.6, 26.0, 13.0), "SSL": (8.0, 0.20, 15.0, 23.0, 11.0),
          "CL": (7.5, 0.25, 32.9, 30.0, 8.0)}
LUMBAR_SOURCE = {
    "LF": "PMC2913991 Table 3, k = E A / L with its moduli, area and length; 67 mm2 are the whole flavum, a row is half of it",
    "CL": "moduli PMC5592017 Table 2; area s13018-021-02237-4 Table 1: 60 mm2, taken for both sides as its 3.6 mm2 of the "
          "intertransverse ligaments are twice the 1.8 of PMC2913991; length 8 mm estimated; k = E A / L"}
LUMBAR_TABLE = "PMC2913991 Table 3, k = E A / L with its moduli, area and length"
# Ligaments between spinous processes carry very little in the first half of flexion and up to 134 N, 0.75 of it the
# interspinous one, at its end (Hukins 1990, abstract, PubMed 2395361): their reference length is the distance at half
# the flexion [deg] of the level, upper vertebra (Bruno 2015, Allaire 2020: data/anatomy/joint_axes.csv) about the
# middle between the longitudinal ligaments.
FLEXION = {"L1": 8.0, "L2": 10.0, "L3": 12.0, "L4": 13.0}
SPINOUS_SOURCE = "; length at half of flexion, as they carry little before (Hukins 1990, PubMed 2395361, abstract)"
# k [N/mm] behind the toe, its length [mm] and its force [N], of the whole ligament: averages of tests at 0.5 1/s,
# bone to bone, of the levels C2-C3 to C7-T1 together (Mattucci and Cronin 2015); flavum: both halves
CERVICAL = {"ALL": (140.4, 1.79, 116.0), "PLL": (217.6, 0.79, 69.0), "LF": (117.7, 3.82, 119.7),
            "CL": (82.2, 1.33, 50.2), "ISL": (19.4, 3.02, 28.6)}
CERVICAL_SOURCE = ("Mattucci and Cronin 2015 J Mech Behav Biomed Mater 41:251, averages at 0.5 1/s as in "
                   "github.com/IMMC-UWaterloo/ARCGen TestCase_MattucciLigaments.m")
# Membrane of the forearm: strand, N/mm, its ends on the crests of radius and ulna, length [mm]. The central band goes from 53,
# 58.5 and 64 % of the radius above the styloid to 29, 36.5 and 44 % of the ulna above its head, the accessory one from 37 to 23
FOREARM = [("central_53", 46, (-0.87, 12.57, -113.13), (1.86, -6.73, -188.58), 51.4),
           ("central_58", 46, (-0.20, 12.35, -100.26), (2.81, -6.63, -171.05), 46.6),
           ("central_64", 46, (1.75, 11.93, -85.31), (0.78, -9.87, -149.29), 39.2),
           ("accessory", 56, (-2.80, 13.92, -152.52), (2.51, -6.01, -205.14), 31.3)]
FOREARM_SOURCE = ("138 +- 24 N/mm of the central band: Pan 2009 Chin J Orthop 29:572 (abstract); it makes 71 % of the "
                  "membrane: Hotchkiss 1989 J Hand Surg 14:256 (abstract), the accessory band the rest; places: Noda 2009 J Hand Surg "
                  "34A:415 (abstract), on the crests of our bones")
# strands and breadth [mm] over which they spread
BROAD = {"ALL": (3, 14), "PLL": (3, 10), "LF": (2, 8), "ISL": (2, 6), "SSL": (1, 0), "CL": (4, 10), "ITL": (1, 0),
         "SI": (3, 16), "sacrospinous": (3, 14), "sacrotuberous": (3, 16), "iliolumbar": (3, 12), "pubic": (3, 14),
         "inguinal": (1, 0), "iliofemoral": (3, 14), "pubofemoral": (2, 10), "ischiofemoral": (3, 14),
         "capsule": (3, 14), "ligamentum": (1, 0), "MCL": (3, 12), "LCL": (2, 6), "ACL": (2, 5), "PCL": (2, 6),
         "PFL": (1, 0), "pCAP": (3, 24), "patellar": (4, 24), "quadriceps": (4, 30), "deltoid": (2, 8),
         "interosseous_talocalcaneal": (2, 8), "spring": (3, 12), "long": (3, 12), "plantar": (3, 20),
         "achilles": (3, 14), "conoid": (2, 8), "trapezoid": (2, 10), "coracoacromial": (2, 12),
         "coracohumeral": (2, 12), "MGHL": (2, 8), "IGHL": (2, 10), "SC": (2, 8), "costoclavicular": (2, 10),
         "tectorial": (3, 10), "anterior": (3, 14), "posterior": (3, 14), "costovertebral": (3, 6),
         "costotransverse": (2, 6), "interosseous": (3, 12)}
# Heights in front and behind [mm], vernier calipers on ten cadavers, by upper vertebra; L5-S1 lacks the one behind. Others:
# 9.3, 10.9, 12.4 in front at L3-L4 to L5-S1 (MRI, 300 patients, Onishi 2019); nucleus at most 8.6 high, SD 1.3, at L4-L5
# (MRI, 41 Chinese, Medicine (Baltimore) 2014, abstract 00005792-201412030-00064). Radiographs of the cadavers' study magnify:
# 14.3 and 9.0 at L3-L4. An earlier table had 12.5 in the middle of L3-L4 (MRI, 14 Iranians, anatomyjournal.ir A-10-159-1).
HEIGHTS = {"L1": (7.92, 4.62), "L2": (9.14, 4.93), "L3": (10.61, 5.87), "L4": (12.57, 6.55)}
HEIGHTS_SOURCE = "mean of {:g} in front and {:g} behind, ten cadavers (Agichani, Joshi and Joshi, jebmh.com 78454, abstract)"
# Cervical discs keep the height that they were measured with: it lies among the sources. In front and behind 4.1 and 3.0 (C2-C3),
# 4.3, 2.8, 4.0, 2.5, 3.6, 2.9, 3.6, 2.5 (C6-C7) in 20 sectioned spines (Lu 1999); in front, in the middle and behind 2.6, 4.1 and
# 1.8 in CT of 1000 men and women (PMC11225399, abstract), over all levels; 4.1 and 5.8 in radiographs of 20 men (e-neurospine 444).
CERVICAL_HEIGHT = "as measured; 4.1 to 3.6 in front, 3.0 to 2.5 behind (20 cadavers, Lu 1999, abstract); PMC11225399; e-neurospine 444"
# rows that the full table lacks: without them the hyoid bone would hang on nothing
ADDED = [
    ["stylohyoid", "head", "R", "skull", "head", 8.0, -38.0, -10.0, "hyoid", "head", 28.0, -12.0, -42.0, "points", 55, 5,
     20, "", "", "", "", 1, 0, "", "E 1200 MPa (VIVA+ v0.2.5, Zajac 1989) would be 109 N/mm; taken softer for the muscle in series; "
     "estimated", "estimated"],
    ["geniohyoid", "head", "M", "mandible", "head", 90.0, 0.0, -45.0, "hyoid", "head", 55.0, 0.0, -48.0, "points", 35, 20,
     5, "", "", "", "", 2, 10, "", "passive muscle; estimated", "estimated"],
    ["thyrohyoid", "neck", "R", "hyoid", "head", 40.0, -16.0, -50.0, "manubrium", "thorax", 85.0, -12.0, 130.0, "points",
     100, 20, 2, "", "", "", "", 1, 0, "", "passive infrahyoid muscles; estimated", "estimated"],
]
# membrane between tibia and fibula, a strand for each 30 mm: E 1170 MPa, 0.54 mm thick, 18 mm wide
# (VIVA+ v0.2.5, Minns-Hunter 1976); k = E t 30 / 18
ADDED += [[f"interosseous_membrane_leg_{z}", "leg", "R", "tibia", "tibia_R", 0.0, -10.0, z + 10.0, "fibula", "tibia_R",
           round(5 - 0.03 * z, 1), round(-24 - 0.046 * z, 1), float(z), "points", 18, 16, 1050, "", "", "", "", 1, 0, "",
           "1170 MPa, 0.54 mm (VIVA+ v0.2.5, Minns-Hunter 1976), a strand for each 30 mm; places estimated", "read"]
          for z in range(60, 331, 30)]
# The annular ligament winds around the head of the radius and the lateral collateral ligament goes to it: the radius turns
# in both. They pull at its axis, 7 mm below the centre of the head: place [mm] in the radius, length [mm] from there
HEAD = (0.06, 1.1, -6.94)
WOUND = {"RCL": 31.9, "annular_anterior": 15.5}
# Parts that are loose where the body stands are as long as the straight way between their ends where they become taut. The
# capsule of the hip is loose behind and below (Gray's Anatomy, in front and above thick): at the end of the range of flexion,
# 28.5 mm more than in standing. The posterior part of the medial ligament of the elbow gets longer by 9 mm from 60 to 120
# degrees of flexion (ours by 9.5; Morrey and An 1985) and restrains the elbow only near 130 (Floris 1998): at 120 degrees.
LOOSE = {
    ("hip", "capsule_inferior"): (66.9, "; loose below (Gray's Anatomy): taut from the end of the range of flexion on, estimated"),
    ("elbow", "MCL_posterior"): (39.3, "; longer by 9 mm from 60 to 120 degrees (Morrey and An 1985 Clin Orthop 201:84, abstract): "
                                       "taut from 120 on, estimated")}
# The posterior cruciate ligament. The source's points, snapped to our bone, lie 12 mm too far up in the notch and 11 mm too
# high on the tibia: 40 % shorter when the knee bends on its path, never taut. On the femur the centres of the bundles are 8 and
# 11.9 mm from the articular surface in front along the roof of the notch, here from (-2.6, -423) to (6, -441) in the plane, and
# 4.7 and 10.9 mm below it; on the tibia they are 8.4 and 14.5 mm below the articular plane. Lengths on the path of our knee at
# 0, 30, 60, 90, 120 degrees: 30.3 28.7 31.3 33.8 36.2 and 36.0 30.6 30.8 33.0 36.8. The front bundle is lax in extension, taut in
# flexion, the rear one hardly ever taut when a knee bends passively (Hosseini Nasab 2016): without force up to 60 degrees, and as
# long as when standing. Ends [mm], reference length [mm]
PCL = {"PCLal": ((-1.7, 6.5, -435.9), (-21.4, -9.9, 381.0), 31.3), "PCLpm": ((-9.0, 10.0, -435.1), (-22.2, -9.1, 375.0), 36.0)}
PCL_SOURCE = ("N/strain of Lenhart et al. 2015 (opensim-jam); on the femur: systematic review 10.1016/j.arthro.2014.07.004 (abstract), on the "
              "tibia: Liu 2009 Acta Anat Sin 40:1008 (abstract), both on our bones; length: tools/joint_tables.py, estimated")
# The capsule of the elbow holds 85 % of a pull in extension and 8 % at 90 degrees of flexion (Morrey and An 1983, abstract): it
# lies in front, from above the fossae of the humerus to the coronoid process and the annular ligament around the radius, which
# brings it to the ulna too. The collateral ligaments fan out from the axis of flexion (the lateral one keeps its length: Morrey
# and An 1985) to both edges of the notch; the fans pull at the axis, in the middle of the trochlea, and hold the ulna in at each angle.
TROCHLEA = (7.0, 1.0, -290.9)
ADDED += [
    ["elbow_capsule", "elbow", "R", "humerus", "humerus_R", 7.4, 0.0, -265.0, "ulna", "ulna_R", 12.4, 2.2, -26.0, "points", 43.6, 20,
     70, "", "", "", "", 3, 20, "", "in front (Morrey and An 1983 Am J Sports Med 11:315, abstract); stiffness and breadth estimated",
     "estimated"],
    *[[f"elbow_fan_{name}", "elbow", "R", "ulna", "ulna_R", *edge, "humerus", "humerus_R", *TROCHLEA, "around", length, 10, 35, "", "",
       "", "", 1, 0, "", "fan of the collateral ligaments from the axis (Morrey and An 1985 Clin Orthop 201:84, abstract) to the edge "
       "of the notch; stiffness estimated", "estimated"]
      for name, edge, length in (("coronoid", (12.4, 2.2, -26.0), 19.8), ("olecranon", (-4.5, 2.0, 0.0), 12.6))]]
ADDED += [
    ["annular_posterior", "elbow", "R", "ulna", "ulna_R", -5.0, -10.2, -31.0, "radius", "radius_R", *HEAD, "around", 13.6, 10,
     30, "", "", "", "", 1, 0, "", "as annular_anterior; behind the radial notch of our ulna", "estimated"],
    # the dorsal one is taut in pronation and at 90 % of its length in supination, as the body stands
    *[[f"radioulnar_{name}", "wrist", "R", "radius", "radius_R", *start, "ulna", "ulna_R", 2.3, -2.65, -266.16, "points",
       length, 15, 50, "", "", "", "", 1, 0, "", "stiffness as radiocarpal_palmar: material similar to the radiocarpal ligaments "
       "(Schuind 1991 J Hand Surg 16A:1106, abstract, the lengths too); from the edge of the notch to the fovea", "estimated"]
      for name, start, length in (("palmar", (11.97, 26.12, -238.16), 17.6), ("dorsal", (-5.6, 27.37, -238.45), 16.5))],
    *[[f"interosseous_membrane_forearm_{name}", "elbow", "R", "radius", "radius_R", *start, "ulna", "ulna_R", *end, "points",
       length, 20, k, "", "", "", "", 1, 0, "", FOREARM_SOURCE, "read"] for name, k, start, end, length in FOREARM],
]
SHORTEST = 4.0  # [mm] reference length of ligaments that the source drew shorter: fibres run along the joint, not across


def table(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def frames(path, unit):
    """{frame: (t, R)} of the standing rows of a table of placements, t in mm"""
    result = {}
    for row in table(path):
        if row["posture"] == "stand":
            values = [float(v) for v in list(row.values())[2:14]]
            result[row["frame"].removesuffix("_R")] = [unit * v for v in values[:3]], values[3:]
    return result


def placed(frame, point):
    t, r = frame
    return [t[i] + sum(r[3 * i + k] * float(point[k]) for k in range(3)) for i in range(3)]


def moved(row, before, after):
    """row of the ligament table with its length changed as the distance of its ends changes between two placements"""
    if (row[1], row[0]) in LOOSE:
        return row
    ends = [(row[i].removesuffix("_R"), row[i + 1:i + 4]) for i in (4, 9)]
    if any(frame not in before or frame not in after for frame, _ in ends):
        return row
    old, new = (math.dist(*(placed(frames[frame], point) for frame, point in ends)) for frames in (before, after))
    if abs(new - old) < 0.05:  # digits of the tables
        return row
    return [*row[:14], f"{float(row[14]) + new - old:.1f}", *row[15:]]


def breadth(name):
    for key, value in BROAD.items():
        if name.startswith(key) and (key not in ("CL", "SC", "LF") or name[len(key):len(key) + 1] in ("_", "")):
            return value
    return 1, 0


def law(row, length):
    """k1 [N/mm], strain1, k2, toe [mm], its force [N], source; one slope: the toe of Blankevoort 1991 is added by the
    program"""
    kind, area = row["name"].split("_")[0], float(row["area_mm2"] or 0)
    source = row["source"]
    if row["stiffness_unit"] == "N/mm (phases)":
        e1, strain, e2, area, l = LUMBAR[kind]
        return (e1 * area / l, strain * l / length, e2 * area / l, "", "", LUMBAR_SOURCE.get(kind, LUMBAR_TABLE))
    if kind in CERVICAL and row["bone1"] in ("C2", "C3", "C4", "C5", "C6", "C7"):
        half = 0.5 if kind == "LF" else 1.0  # a row is one side
        k, toe, force = CERVICAL[kind]
        return half * k, "", "", toe, half * force, CERVICAL_SOURCE
    k = float(row["stiffness"] or 0)
    return (k / length if row["stiffness_unit"].startswith("N/strain") else k), "", "", "", "", source


def place(row):
    """mean of the ends along x [mm], each in the frame of its bone"""
    return 0.5 * (float(row["x1_mm"]) + float(row["x2_mm"]))


def flexed(rows, row):
    """by how much half of flexion lengthens a ligament between spinous processes [mm]"""
    level = row["name"].split("_", 1)[1]
    middle = sum(place(r) for r in rows if r["name"] in ("ALL_" + level, "PLL_" + level)) / 2
    return math.radians(FLEXION[row["bone1"]] / 2) * (middle - place(row))


def ligaments(folder):
    rows = table(folder / "joints_ligaments.csv")
    for row in rows:
        if row["name"].startswith("interosseous_membrane_forearm"):
            continue  # FOREARM
        length = max(float(row["length_stand_mm"]), SHORTEST)
        spinous = row["name"].split("_")[0] in ("ISL", "SSL") and row["bone1"] in FLEXION
        if spinous:
            length = round(length + flexed(rows, row), 1)
        if row["name"].startswith("CL_"):
            length = 8.0 if row["bone1"].startswith("L") else 6.0
        k1, e1, k2, toe, force, source = law(row, length)
        source += SPINOUS_SOURCE if spinous else ""
        strands, spread = breadth(row["name"])
        slack = row["note"].split("slack ")[1].split(" mm")[0] if "slack" in row["note"] else ""
        ends = [row[c] for c in ("x1_mm", "y1_mm", "z1_mm", "x2_mm", "y2_mm", "z2_mm")]
        ends = ["0.0" if float(v) == 0 else v for v in ends]
        attach = "facet" if row["name"].startswith("CL_") else "points"
        if row["name"] in ("achilles_tendon", "quadriceps_tendon_insertion"):
            attach, k1, source = "muscle", 10.0, "tendon in series with a passive muscle; estimated"
        if (row["region"], row["name"]) in LOOSE:
            length, why = LOOSE[row["region"], row["name"]]
            source += why
        if row["name"] in PCL:
            start, end, length = PCL[row["name"]]
            ends, slack, source = [*start, *end], "", PCL_SOURCE
            k1 = float(row["stiffness"]) / length
        if row["name"] in WOUND:
            attach, length, ends[3:] = "around", WOUND[row["name"]], HEAD
        if row["name"] == "inguinal":
            source += "; both ends on the hip bone"
        lumbar = row["stiffness_unit"] == "N/mm (phases)"
        area = f"{LUMBAR[row['name'].split('_')[0]][3]:g}" if lumbar else row["area_mm2"]
        confidence = "read" if lumbar or source == CERVICAL_SOURCE else row["confidence"]
        yield [row["name"], row["region"], row["side"], row["bone1"], row["frame1"], *ends[:3], row["bone2"],
               row["frame2"], *ends[3:], attach, f"{length:g}", area,
               f"{k1:.4g}", e1 and f"{e1:.4g}", k2 and f"{k2:.4g}",
               toe and f"{toe:g}", force and f"{force:.4g}", strands, spread, slack, source, confidence]


def discs(folder):
    for row in table(folder / "bones/discs.csv"):
        upper, lower = row["disc"].split("_")
        if upper in HEIGHTS:
            height, source = round(sum(HEIGHTS[upper]) / 2, 1), HEIGHTS_SOURCE.format(*HEIGHTS[upper])
        elif upper == "L5":
            height, source = float(row["mean_height_mm"]), "as measured; in front 12.4 (Onishi 2019), 12.6 (Agichani)"
        elif upper.startswith("C"):
            height, source = float(row["mean_height_mm"]), CERVICAL_HEIGHT
        else:
            height, source = float(row["mean_height_mm"]), "as measured; Fletcher 2015: 2.7 (T4-5) to 5.4 (T10-11)"
        yield [row["disc"], upper, "sacrum" if lower == "S1" else lower,
               *(f"{1000 * float(row[c]):.1f}" for c in ("x_stand_m", "y_stand_m", "z_stand_m")),
               row["nx"], row["ny"], row["nz"], row["width_mm"], row["depth_mm"], row["area_mm2"],
               row["mean_height_mm"], f"{height:g}", source]


def write(path, comment, columns, rows):
    with open(path, "w", encoding="utf-8", newline="") as file:
        file.write(comment)
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(rows)


def main():
    folder, target = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    notice = ("# Attachments and sizes measured from BodyParts3D, (c) The Database Center for Life Science, CC BY-SA 4.0;"
              " changes: scaled per region, reduced to points. See LICENSE in data/anatomy.\n")
    before, after = frames(folder / "assembly.csv", 1000), frames(target.parent / "assembly.csv", 1)
    write(target / "ligaments.csv", notice +
          "# Ends in the frames of the bones [mm], right side or midline; attach around:"
          " end 2 is on the axis of a head that the ligament winds around. length: reference, of strains. k1 to strain1, k2"
          " beyond [N/mm of the whole ligament];\n# without strain1: one slope k1 behind a toe, measured (its length"
          " toe [mm], its force toe_force [N]) or of 6 % strain. strands over a breadth"
          " of spread. slack: length without force, where the source states one.\n",
          ["name", "region", "side", "bone1", "frame1", "x1", "y1", "z1", "bone2", "frame2", "x2", "y2", "z2", "attach",
           "length", "area", "k1", "strain1", "k2", "toe", "toe_force", "strands", "spread", "slack", "source", "confidence"],
          [moved(row, before, after) for row in [*ligaments(folder), *ADDED]])
    write(target / "discs.csv", notice +
          "# Centre and normal in the standing assembly [mm], global; width along y, depth along x; height: measured mean,"
          " height_am50: to aim at.\n",
          ["disc", "upper", "lower", "x", "y", "z", "nx", "ny", "nz", "width", "depth", "area", "height", "height_am50",
           "source"], discs(folder))


if __name__ == "__main__":
    main()
