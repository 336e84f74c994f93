import unittest

import support  # noqa: F401, so that the package is found
from support import FAKE_BLENDER, ProgramTest

import seedframe

try:
    import torch
except ImportError:
    torch = None


@unittest.skipIf(torch is None, "PyTorch is not installed here; scripts/python_checks.sh runs this where it is")
class Datasets(ProgramTest):
    def streamed(self, loader_workers, **options):
        from seedframe.torch import StreamDataset

        dataset = StreamDataset(
            self.config,
            ({"turn": turn} for turn in range(0))
            if options.pop("empty", False)
            else [{"turn": 4 * k} for k in range(20)],
            fidelity="labels",
            transform=lambda frame: frame.frame_id,
            **options,
        )
        loader = torch.utils.data.DataLoader(dataset, batch_size=None, num_workers=loader_workers)
        return [list(loader) for _ in range(2)]

    def test_processes_share_the_frames_of_one(self):
        (alone, again) = self.streamed(0)
        self.assertEqual(len(set(alone)), 20)
        self.assertEqual(alone, again)
        (shared, _) = self.streamed(2)
        self.assertEqual(shared, alone)  # a DataLoader takes from its processes in turn
        self.assertEqual(self.streamed(0, empty=True)[0], [])

    def test_frames_without_end_are_those_of_the_scenes(self):
        import itertools

        from seedframe.torch import StreamDataset

        dataset = StreamDataset(self.config, fidelity="labels", transform=lambda frame: frame.frame_id)
        first = list(itertools.islice(iter(dataset), 5))
        dataset.set_scene(3)
        self.assertEqual(next(iter(dataset)), first[3])

    def test_pictures_become_tensors(self):
        from seedframe.torch import StreamDataset

        dataset = StreamDataset(self.config, [{}], fidelity="render", blender=FAKE_BLENDER)
        ((image, target),) = list(dataset)
        self.assertEqual((image.shape, image.dtype), ((3, 32, 48), torch.float32))
        self.assertEqual(target["boxes"].shape, (len(target["labels"]), 4))

    def test_a_campaign(self):
        from seedframe.torch import CampaignDataset

        campaign = seedframe.submit(self.config, self.folder / "c", blender=FAKE_BLENDER)
        dataset = CampaignDataset(campaign.path)
        self.assertEqual(len(dataset), 6)
        loader = torch.utils.data.DataLoader(dataset, batch_size=None, num_workers=2)
        images = [image for image, _ in loader]
        for image, frame in zip(images, campaign):
            self.assertTrue(
                torch.equal((image * 255).round().to(torch.uint8), torch.from_numpy(frame.image).permute(2, 0, 1))
            )

    def test_batches_are_tensors_without_a_copy(self):
        with seedframe.Stream(self.config, "render", blender=FAKE_BLENDER) as stream:
            (batch,) = stream.render_batches([{}, {}, {}], 3)
        pixels = torch.from_numpy(batch.image)
        self.assertEqual(pixels.shape, (3, 32, 48, 3))
        self.assertEqual(pixels.data_ptr(), batch.frames[0].image.ctypes.data)


if __name__ == "__main__":
    unittest.main()
