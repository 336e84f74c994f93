"""BOP against the truth."""

from __future__ import annotations

from collections import Counter

import bop
import compare
import numpy as np
from common import Annotation, Dataset, tight_box
from compare import Report
from source import Campaign, Frame, Instance

PROJECTION = 0.01  # pixels
FLOAT32 = 1e-4  # millimetres: vertices of a metre in single precision
MOST_VERTICES = 3000
LEAST_VISIBLE = 0.1  # of what is to be found


def corners_of_box(box: np.ndarray) -> np.ndarray:
    """The 8 corners (8, 3) of a box (2, 3): x alternates fastest, then y, then z."""
    return np.array([[box[i & 1, 0], box[i >> 1 & 1, 1], box[i >> 2 & 1, 2]] for i in range(8)])


def toolkit_box(box: tuple[int, int, int, int]) -> list[int]:
    """scene_gt_info's convention: sides are largest - smallest, -1 four times for nothing."""
    x, y, width, height = box
    return [x, y, width - 1, height - 1] if width and height else [-1, -1, -1, -1]


def check_model(
    where: str, vertices: np.ndarray, triangles: np.ndarray, info: dict, report: Report
) -> None:
    """models_info against the vertices; the diameter by its bounds, where there are many."""
    low, size = vertices.min(axis=0), np.ptp(vertices, axis=0)
    for i, axis in enumerate("xyz"):
        good = abs(info[f"min_{axis}"] - low[i]) <= FLOAT32
        good &= abs(info[f"size_{axis}"] - size[i]) <= FLOAT32
        report.check(good, f"{where}: min or size along {axis} is not that of the vertices")
    report.check(
        triangles.min() >= 0 and triangles.max() < len(vertices), f"{where}: a face without vertex"
    )
    sample = vertices
    if len(vertices) > MOST_VERTICES:
        sample = np.random.default_rng(0).choice(vertices, MOST_VERTICES, replace=False)
    squares = (sample**2).sum(axis=1)
    largest = (squares[:, None] + squares - 2 * sample @ sample.T).max()
    least, most = float(np.sqrt(max(largest, 0))), float(np.linalg.norm(size))
    diameter = info["diameter"]
    report.check(
        least - FLOAT32 <= diameter <= most + FLOAT32,
        f"{where}: diameter {diameter}, between {least} and {most}",
    )
    if len(vertices) <= MOST_VERTICES:
        report.check(abs(diameter - least) <= FLOAT32, f"{where}: diameter {diameter}, not {least}")


def check_normals(
    where: str, vertices: np.ndarray, triangles: np.ndarray, normals: np.ndarray, report: Report
) -> None:
    """Of length 1, on the outer side of nearly all triangles that they shade."""
    if not report.check(normals is not None, f"{where}: no normals"):
        return
    lengths = np.linalg.norm(normals, axis=1)
    report.check(np.abs(lengths - 1).max() < 1e-5, f"{where}: normals of other lengths than 1")
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    faces = np.cross(b - a, c - a)
    inwards = np.einsum("ijk,ik->ij", normals[triangles], faces) <= 0
    report.check(inwards.mean() < 0.01, f"{where}: {inwards.sum()} corners are shaded from inside")


def _check_models(dataset: Dataset, campaign: Campaign, report: Report) -> None:
    extras = dataset.extras
    models = extras["models"]
    assets = [models[i]["asset"] for i in sorted(models)]
    report.check(sorted(models) == list(range(1, len(models) + 1)), "object ids are not 1, 2, ...")
    report.check(assets == sorted(assets), "objects are not in the order of their assets' names")
    report.check(
        set(models) == set(extras["meshes"]) == set(extras["models_info"]),
        "models.json, models_info.json and the PLY files are of different objects",
    )
    for number, (vertices, triangles, normals) in sorted(extras["meshes"].items()):
        info = extras["models_info"][number]
        check_model(f"obj_{number:06}", vertices, triangles, info, report)
        check_normals(f"obj_{number:06}", vertices, triangles, normals, report)
    bounds = {
        i.asset: i.object_box * 1000 for frame in campaign.frames.values() for i in frame.instances
    }
    for number, model in models.items():
        if model["asset"] in bounds:
            vertices = extras["meshes"][number][0]
            box = np.stack([vertices.min(axis=0), vertices.max(axis=0)])
            good = np.abs(box - bounds[model["asset"]]).max() <= FLOAT32
            report.check(good, f"{model['asset']}: the model has another box than object_box_m")


def _check_pose(
    where: str, frame: Frame, instance: Instance, extras: dict, camera: dict, report: Report
) -> None:
    rotation = np.reshape(extras["cam_R_m2c"], (3, 3))
    rigid = np.abs(rotation @ rotation.T - np.eye(3)).max() < 1e-6 and np.linalg.det(rotation) > 0
    report.check(rigid, f"{where}: cam_R_m2c is no rotation")
    flip = np.array([1.0, -1.0, -1.0])
    report.check(
        np.abs(rotation - instance.rotation * flip[:, None]).max() < 1e-6
        and np.abs(extras["cam_t_m2c"] - 1000 * instance.translation * flip).max() < 1e-4,
        f"{where}: another pose than labels.json",
    )
    points = corners_of_box(instance.object_box) * 1000
    pixels = bop.project(points, rotation, extras["cam_t_m2c"], camera["cam_K"])
    expected = np.array([(np.nan, np.nan) if c is None else c for c in instance.corners]) - 0.5
    good = np.allclose(pixels, expected, rtol=0, atol=PROJECTION, equal_nan=True)
    report.check(good, f"{where}: the object's box projects to other pixels than labels.json says")


def _check_instance(
    frame: Frame, instance: Instance, annotation: Annotation, image: dict, report: Report
) -> None:
    where, extras = f"{frame.stem}/{instance.id}", annotation.extras
    depth = image["depth"]
    valid = 0 if depth is None else int((instance.silhouette & (depth != 0)).sum())
    share = instance.area / instance.amodal_area
    wanted = {
        "px_count_all": instance.amodal_area,
        "px_count_visib": instance.area,
        "px_count_valid": valid,
        "bbox_obj": toolkit_box(instance.amodal_box),
        "bbox_visib": toolkit_box(instance.visible_box),
    }
    for key, value in wanted.items():
        report.check(extras[key] == value, f"{where}: {key} {extras[key]}, not {value}")
    report.check(abs(extras["visib_fract"] - share) < 1e-6, f"{where}: visib_fract")
    report.check(extras["asset"] == instance.asset, f"{where}: obj_id is of {extras['asset']}")
    compare.same_mask(where, extras["mask"], instance.silhouette, report, "full mask")
    compare.same_mask(where, extras["coco_mask"], instance.visible, report, "scene_gt_coco's mask")
    coco = extras["coco"]
    identity = (frame.index + 1) * 100000 + instance.id
    found = (coco["id"], coco["image_id"], coco["category_id"], coco["area"], coco["iscrowd"])
    expected = (identity, frame.index, extras["obj_id"], instance.area, 0)
    report.check(found == expected, f"{where}: scene_gt_coco has {found}, not {expected}")
    found = (coco["bbox"], coco["ignore"], coco["width"], coco["height"])
    amodal = list(tight_box(instance.silhouette))
    expected = (amodal, instance.visible_fraction < LEAST_VISIBLE, frame.width, frame.height)
    report.check(found == expected, f"{where}: scene_gt_coco has {found}, not {expected}")
    _check_pose(where, frame, instance, extras, image["camera"], report)


def _check_image(frame: Frame, image: dict, report: Report) -> None:
    fx, fy = frame.focal
    cx, cy = frame.centre
    matrix = [fx, 0, cx, 0, fy, cy, 0, 0, 1]
    good = np.allclose(image["camera"]["cam_K"], matrix, rtol=0, atol=1e-6)
    report.check(good, f"{frame.stem}: cam_K {image['camera']['cam_K']}")
    depth, scale = image["depth"], image["camera"]["depth_scale"]
    report.check(np.log10(scale * 10).round(9) in range(9), f"{frame.stem}: depth_scale {scale}")
    report.check((depth is not None) == frame.has_depth, f"{frame.stem}: depth, or none")
    if depth is None:
        return
    good = depth.shape == (frame.height, frame.width) and 0 <= depth.min() <= depth.max() < 65536
    report.check(good, f"{frame.stem}: depth image of {depth.shape}")
    for instance in frame.instances:
        # What is seen of an object is inside the sphere around its box, which has a depth range.
        x, y, z = instance.rotation @ instance.object_box.mean(axis=0) + instance.translation
        radius = np.linalg.norm(np.ptp(instance.object_box, axis=0)) / 2
        seen = depth[instance.visible] * scale
        far = np.abs(seen + 1000 * z).max() > 1000 * radius + 0.5 * scale
        report.check(not far, f"{frame.stem}/{instance.id}: depth outside the object's box")


def _check_camera(dataset: Dataset, campaign: Campaign, report: Report) -> None:
    """camera.json is that of the first frame."""
    stem = min(campaign.frames)
    frame, image = campaign.frames[stem], dataset.extras["images"][stem]
    (fx, fy), (cx, cy) = frame.focal, frame.centre
    wanted = {"width": frame.width, "height": frame.height, "fx": fx, "fy": fy, "cx": cx, "cy": cy}
    if frame.has_depth:
        wanted["depth_scale"] = image["camera"]["depth_scale"]
    found = dataset.extras["camera"]
    report.check(found == wanted, f"camera.json: {found}, not {wanted}")


def _check_targets(dataset: Dataset, report: Report) -> None:
    for split, targets in dataset.extras["targets"].items():
        counts: Counter = Counter()
        for annotation in dataset.annotations:
            if annotation.split == split and annotation.extras["visib_fract"] >= LEAST_VISIBLE:
                scene, image = dataset.scenes[annotation.stem], int(annotation.stem)
                counts[scene, image, annotation.extras["obj_id"]] += 1
        listed = {(t["scene_id"], t["im_id"], t["obj_id"]): t["inst_count"] for t in targets}
        good = listed == dict(counts) and len(listed) == len(targets)
        report.check(good, f"{split}_targets_bop19.json: other counts than scene_gt has visible")


def check(dataset: Dataset, campaign: Campaign, report: Report) -> None:
    """Masks and boxes of both kinds, poses, counts, models, targets."""
    ids = [a.extras["coco"]["id"] for a in dataset.annotations]
    report.check(len(ids) == len(set(ids)), "an annotation id occurs twice")
    pairs = compare.compare_annotations(dataset, campaign, report, bop=True)
    for frame, instance, annotation in pairs:
        image = dataset.extras["images"][frame.stem]
        _check_instance(frame, instance, annotation, image, report)
    for stem, image in dataset.extras["images"].items():
        if stem in campaign.frames:
            _check_image(campaign.frames[stem], image, report)
    _check_models(dataset, campaign, report)
    _check_camera(dataset, campaign, report)
    _check_targets(dataset, report)
