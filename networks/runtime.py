# SPDX-License-Identifier: MIT
"""Runs the exported files on one thread, with OpenVINO where it is installed, else with ONNX Runtime."""

import time

import numpy as np

THREADS = 1


def masks_file(file):
    """The second network, beside the first."""
    return file.with_name(file.stem + "_masks.onnx")


def open_openvino(file):
    """Name of the program, and a function from inputs to outputs by name."""
    import openvino

    options = {"INFERENCE_NUM_THREADS": THREADS, "INFERENCE_PRECISION_HINT": "f32"}
    model = openvino.Core().compile_model(str(file), "CPU", options)
    size = model.input("image").shape[-1]
    run = lambda feed: {name: v for output, v in model(feed).items() for name in output.get_names()}
    return f"OpenVINO {openvino.__version__.split('-')[0]}", size, run


def open_onnxruntime(file):
    import onnxruntime

    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = options.inter_op_num_threads = THREADS
    session = onnxruntime.InferenceSession(str(file), options, providers=["CPUExecutionProvider"])
    names = [output.name for output in session.get_outputs()]
    run = lambda feed: dict(zip(names, session.run(names, feed), strict=True))
    return f"ONNX Runtime {onnxruntime.__version__}", session.get_inputs()[0].shape[-1], run


def open_file(file):
    try:
        return open_openvino(file)
    except ImportError:
        return open_onnxruntime(file)


class Runtime:
    def __init__(self, file):
        self.name, self.size, self._run = open_file(file)
        second = masks_file(file)
        self._run_masks = open_file(second)[2] if second.exists() else None

    def __call__(self, image, depth, height):
        """image u8 [3,S,S], depth and height f32 [1,S,S] -> the five outputs without their batch axis, and, where
        there is a second network, `drawn`: (goal, box) -> (shares [h,w], edges of their window [input px])."""
        feed = {"image": image[None].astype(np.float32) / 255, "depth": depth[None], "height": height[None]}
        answer = {name: value[0] for name, value in self._run(feed).items()}
        if self._run_masks:
            def drawn(goal, box):
                more = {"share": answer["mask"][None, goal : goal + 1], "box": np.asarray(box, np.float32)[None]}
                out = self._run_masks(feed | more)
                return out["mask"][0, 0], out["window"][0]

            answer["drawn"] = drawn
        return answer

    def milliseconds(self, inputs, repeats=60):
        """Medians of the processor time of one frame, and of one box of it."""
        answer = self(**inputs)
        box = (self.size // 4, self.size // 4, 3 * self.size // 4, 3 * self.size // 4)
        frame = median_ms(lambda: self(**inputs), repeats)
        return frame, median_ms(lambda: answer["drawn"](0, box), repeats) if self._run_masks else 0.0


def median_ms(run, repeats):
    times = []
    for _ in range(repeats):
        start = time.process_time()
        run()
        times.append(time.process_time() - start)
    return 1000 * float(np.median(times))
