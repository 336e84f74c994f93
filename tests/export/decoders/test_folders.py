"""The decoders of VOC, BOP, WebDataset, patches, statistics and campaigns on small examples."""

from __future__ import annotations

import io
import json
import struct
import tarfile
import unittest

import bop
import check_bop
import check_others
import numpy as np
import patches
import source
import stats
import voc
import webdataset
from compare import Report
from examples import InFolder, mask_of, png
from PIL import Image

XML = """<annotation><folder>VOC2012</folder><filename>000003.jpg</filename>
<size><width>3</width><height>2</height><depth>3</depth></size><segmented>1</segmented>
<object><name>nut</name><pose>Unspecified</pose><truncated>1</truncated><occluded>0</occluded>
<difficult>0</difficult>
<bndbox><xmin>2</xmin><ymin>1</ymin><xmax>3</xmax><ymax>1</ymax></bndbox></object></annotation>"""


class Voc(InFolder):
    def test_colours(self) -> None:
        colours = voc.colour_map()
        self.assertEqual(colours[[1, 2, 8, 15, 255]].tolist(), [
            [128, 0, 0], [0, 128, 0], [64, 0, 0], [192, 128, 128], [224, 224, 192]
        ])  # fmt: skip

    def test_load(self) -> None:
        base = "VOCdevkit/VOC2012"
        self.write(f"{base}/labelmap.txt", "background:0,0,0::\nbolt:128,0,0::\nnut:0,128,0::\n")
        self.write(f"{base}/Annotations/000003.xml", XML)
        for name in ("Main", "Segmentation"):
            self.write(f"{base}/ImageSets/{name}/train.txt", "000003\n")
        self.write(f"{base}/ImageSets/Main/bolt_train.txt", "000003 -1\n")
        values = np.array([[0, 1, 1], [0, 0, 0]], np.uint8)
        self.write(f"{base}/SegmentationObject/000003.png", png(values, "P"))
        self.write(f"{base}/SegmentationClass/000003.png", png(2 * values, "P"))
        dataset = voc.load(self.folder)
        (found,) = dataset.annotations
        self.assertEqual((found.name, found.box, found.split), ("nut", (1, 0, 2, 1), "train"))
        self.assertEqual(found.extras, {"truncated": 1, "occluded": 0, "difficult": 0})
        np.testing.assert_array_equal(found.mask, values == 1)
        self.assertEqual(dataset.problems, [])
        self.assertEqual(dataset.extras["class_sets"], {"bolt_train": {"000003": -1}})
        self.write(f"{base}/SegmentationClass/000003.png", png(values, "P"))
        self.assertEqual(len(voc.load(self.folder).problems), 1)

    def test_folder_names(self) -> None:
        self.assertEqual(voc.folder_names(["a b", "a_b", "c.d"]), ["a_b~1", "a_b", "c.d"])


class Bop(InFolder):
    HEADER = (
        "ply\nformat {} 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    )
    VERTICES = ((0.0, 0.0, 0.0), (3.0, 0.0, 0.0), (0.0, 4.0, 0.0))

    def test_ply(self) -> None:
        text = self.HEADER.format("ascii") + "0 0 0\n3 0 0\n0 4 0\n3 0 1 2\n"
        numbers = b"".join(struct.pack("<3f", *vertex) for vertex in self.VERTICES)
        binary = self.HEADER.format("binary_little_endian").encode() + numbers
        self.write("text.ply", text)
        self.write("binary.ply", binary + struct.pack("<B3i", 3, 0, 1, 2))
        self.write("short.ply", binary)
        for name in ("text.ply", "binary.ply"):
            vertices, triangles, normals = bop.read_ply(self.folder / name)
            self.assertIsNone(normals)
            self.assertEqual(vertices.tolist(), [list(vertex) for vertex in self.VERTICES])
            self.assertEqual(triangles.tolist(), [[0, 1, 2]])
        with self.assertRaises(ValueError):
            bop.read_ply(self.folder / "short.ply")

    def test_model(self) -> None:
        info = {"diameter": 5.0, "min_x": 0, "min_y": 0, "min_z": 0}
        info |= {"size_x": 3, "size_y": 4, "size_z": 0}
        for diameter, faults in ((5.0, 0), (4.9, 2)):
            report = Report("bop")
            arrays = np.array(self.VERTICES), np.array([[0, 1, 2]])
            check_bop.check_model("m", *arrays, info | {"diameter": diameter}, report)
            self.assertEqual(len(report.differences), faults)

    def test_normals(self) -> None:
        header = self.HEADER.replace("z\nelement", "z\n" + "".join(
            f"property float n{axis}\n" for axis in "xyz") + "element")  # fmt: skip
        text = header.format("ascii") + "0 0 0 0 0 1\n3 0 0 0 0 1\n0 4 0 0 0 1\n3 0 1 2\n"
        self.write("shaded.ply", text)
        vertices, triangles, normals = bop.read_ply(self.folder / "shaded.ply")
        self.assertEqual(normals.tolist(), [[0, 0, 1]] * 3)
        for turned, faults in ((normals, 0), (-normals, 1), (2 * normals, 1), (None, 1)):
            report = Report("bop")
            check_bop.check_normals("m", vertices, triangles, turned, report)
            self.assertEqual(len(report.differences), faults)

    def test_projection(self) -> None:
        matrix = [100, 0, 50, 0, 100, 40, 0, 0, 1]
        turn = [0, -1, 0, 1, 0, 0, 0, 0, 1]
        pixels = bop.project(np.array([[10.0, 0, 0], [0, 0, -600]]), turn, [0, 0, 500], matrix)
        np.testing.assert_allclose(pixels, [[50, 42], [np.nan, np.nan]])

    def test_boxes(self) -> None:
        self.assertEqual(check_bop.toolkit_box((4, 5, 1, 2)), [4, 5, 0, 1])
        self.assertEqual(check_bop.toolkit_box((0, 0, 0, 0)), [-1] * 4)


class WebDataset(InFolder):
    def shard(self, names: list[str], mode: int = 0o644) -> bytes:
        entry = {"id": 100004, "image_id": 1, "category_id": 1, "category": "nut"}
        entry |= {"bbox": [1, 0, 1, 1], "segmentation": {"size": [1, 2], "counts": "11"}}
        document = {"frame": 0, "scene": 6, "width": 2, "height": 1, "image_id": 1}
        document["annotations"] = [entry]
        contents = {
            "000000.json": json.dumps(document).encode(),
            "000000.instances.png": png(np.array([[0, 4]], np.uint16)),
            "000001.json": b"{}",
        }
        file = io.BytesIO()
        with tarfile.open(fileobj=file, mode="w", format=tarfile.USTAR_FORMAT) as archive:
            for name in names:
                member = tarfile.TarInfo(name)
                member.size, member.mode = len(contents[name]), mode
                archive.addfile(member, io.BytesIO(contents[name]))
        return file.getvalue()

    def test_load(self) -> None:
        names = ["000000.instances.png", "000000.json"]
        self.write("webdataset/train-000000.tar", self.shard(names))
        dataset = webdataset.load(self.folder / "webdataset")
        (found,) = dataset.annotations
        self.assertEqual((found.stem, found.name, found.box), ("000000", "nut", (1, 0, 1, 1)))
        np.testing.assert_array_equal(found.mask, mask_of(".#"))
        np.testing.assert_array_equal(found.extras["ids_mask"], mask_of(".#"))
        self.assertEqual((dataset.scenes, dataset.problems), ({"000000": 6}, []))

    def test_order_and_headers(self) -> None:
        apart = ["000000.instances.png", "000001.json", "000000.json"]
        for data in (self.shard(apart), self.shard(["000000.json"], 0o600)):
            with self.assertRaises(ValueError):
                list(webdataset.samples_of_shard(data))


class Patches(InFolder):
    def test_load(self) -> None:
        self.write("classes.json", [{"folder": "a_b~1", "name": "a b"}])
        self.write("train/a_b~1/000042_00003.png", png(np.zeros((4, 4, 3), np.uint8)))
        (self.folder / "val/a_b~1").mkdir(parents=True)
        dataset = patches.load(self.folder)
        (found,) = dataset.annotations
        self.assertEqual((found.stem, found.split, found.name), ("000042", "train", "a b"))
        self.assertEqual((found.extras["id"], found.extras["pixels"].shape), (3, (4, 4, 3)))
        self.assertEqual(dataset.splits, {"train": ["000042"], "val": []})
        self.assertEqual(dataset.problems, [])
        (self.folder / "train/empty").mkdir()
        self.assertEqual(len(patches.load(self.folder).problems), 3)


class Statistics(unittest.TestCase):
    def test_bins(self) -> None:
        edges = [2, 4, 8]
        self.assertEqual([stats.size_bin(n, edges) for n in (3, 4, 15, 16, 9999)], [0, 1, 1, 2, 2])
        self.assertEqual([stats.tenth(n, 10) for n in (0, 3, 9, 10)], [0, 3, 9, 9])
        self.assertEqual(stats.cell((0, 0, 2, 2), 16, 16), 0)
        self.assertEqual(stats.cell((3, 14, 2, 2), 16, 16), 7 * 8 + 2)


class Source(InFolder):
    def frame(self, version: int) -> None:
        pose = {"rotation": [1, 0, 0, 0, 1, 0, 0, 0, 1], "scale": [1, 1, 1]}
        amodal = {"area_px": 4, "in_image_px": 3, "box": [1, -1, 2, 2], "rle": "04"}
        amodal |= {"complete": True, "object_box_m": [[0, 0, 0], [1, 1, 1]]}
        amodal |= {"box_corners_px": [None] * 8, "pose": pose | {"translation_m": [0, 0, -1]}}
        nut = {"id": 7, "category": 1, "asset": "nut", "name": "nut/0", "truncation": 0.5}
        nut |= {"area_px": 1, "box": [2, 0, 1, 1], "visible_fraction": 0.25, "amodal": amodal}
        nut["keypoints"] = [{"name": "tip", "px": [1.5, 0.5], "visibility": 1}]
        cone = nut | {"id": 9, "category": 0}
        labels = {"version": version, "width": 4, "height": 2, "twin_exact": True}
        labels |= {"categories": ["nut"], "camera": {"focal_px": [9, 9], "center_px": [1.5, 0.5]}}
        labels["instances"] = [nut, cone]
        base = "frames/001/001002"
        self.write(f"{base}/labels.json", labels)
        ids = np.array([[0, 0, 7, 9], [0, 0, 0, 0]], np.uint16)
        self.write(f"{base}/instances.png", png(ids))
        self.write(f"{base}/manifest.json", {"frame_id": "ab", "files": {}})

    def picture(self, name: str, content: str, **manifest: dict) -> None:
        """A picture in the frame's folder, as PIL writes it."""
        self.frame(3)
        (labels,) = self.folder.glob("frames/*/*/labels.json")
        document = json.loads(labels.read_text())
        document["instances"][0]["amodal"]["in_image_px"] = 2
        labels.write_text(json.dumps(document))
        out = io.BytesIO()
        Image.new("RGB", (4, 2), (200, 40, 40)).save(out, content)
        base = labels.parent.relative_to(self.folder)
        self.write(f"{base}/{name}", out.getvalue())
        self.write(f"{base}/manifest.json", {"frame_id": "ab", "files": {name: {}}} | manifest)

    def test_pictures(self) -> None:
        for format, name in (("jpeg", "jpg"), ("webp", "webp"), ("tiff", "tif"), ("png", "png")):
            self.picture(f"image.{name}", format, image={"format": format})
            frame = source.read(self.folder).frames["001002"]
            self.assertEqual(frame.image.name, f"image.{name}")
        self.picture("image.png", "png")  # the manifest need not say so
        self.assertTrue(source.read(self.folder).has_images)

    def test_refuses_pictures_of_another_format_than_said(self) -> None:
        self.picture("image.jpg", "png", image={"format": "jpeg"})
        with self.assertRaisesRegex(ValueError, "a PNG, and the manifest says JPEG"):
            source.read(self.folder)
        self.picture("image.jpg", "jpeg")
        with self.assertRaisesRegex(ValueError, "the manifest says PNG"):
            source.read(self.folder)

    def test_read(self) -> None:
        self.frame(3)
        (labels,) = self.folder.glob("frames/*/*/labels.json")
        document = json.loads(labels.read_text())
        document["instances"][0]["amodal"]["in_image_px"] = 2
        labels.write_text(json.dumps(document))
        campaign = source.read(self.folder, amodal=True)
        frame = campaign.frames["001002"]
        (nut,) = frame.instances
        self.assertEqual((frame.index, frame.frame_id, campaign.has_images), (1002, "ab", False))
        np.testing.assert_array_equal(nut.mask, mask_of(".##.", "...."))
        self.assertEqual((nut.box, nut.visible_box), ((1, 0, 2, 1), (2, 0, 1, 1)))
        self.assertEqual(check_others.voc_flags(nut), (1, 0))
        self.assertEqual(source.read(self.folder, min_visible=0.3).frames["001002"].instances, [])
        self.assertEqual(source.read(self.folder, min_pixels=2).frames["001002"].instances, [])

    def test_refuses(self) -> None:
        self.frame(3)  # says that 3 pixels of the silhouette are in the image; there are 2
        with self.assertRaises(ValueError):
            source.read(self.folder)
        self.frame(2)
        with self.assertRaises(ValueError):
            source.read(self.folder)


if __name__ == "__main__":
    unittest.main()
