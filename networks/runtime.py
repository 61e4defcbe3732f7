# SPDX-License-Identifier: MIT
"""Runs the exported file on one thread, with OpenVINO where it is installed, else with ONNX Runtime."""

import time

import numpy as np


class Runtime:
    def __init__(self, file):
        try:
            self._open_openvino(file)
        except ImportError:
            self._open_onnxruntime(file)

    def _open_openvino(self, file):
        import openvino

        options = {"INFERENCE_NUM_THREADS": 1, "INFERENCE_PRECISION_HINT": "f32"}
        model = openvino.Core().compile_model(str(file), "CPU", options)
        names = [output.get_any_name() for output in model.outputs]
        self.name = f"OpenVINO {openvino.__version__.split('-')[0]}"
        self.size = model.input("image").shape[-1]
        self._run = lambda feed: {n: v for n, v in zip(names, model(feed).values(), strict=True)}

    def _open_onnxruntime(self, file):
        import onnxruntime

        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = options.inter_op_num_threads = 1
        session = onnxruntime.InferenceSession(str(file), options, providers=["CPUExecutionProvider"])
        names = [output.name for output in session.get_outputs()]
        self.name = f"ONNX Runtime {onnxruntime.__version__}"
        self.size = session.get_inputs()[0].shape[-1]
        self._run = lambda feed: dict(zip(names, session.run(names, feed), strict=True))

    def __call__(self, image, depth, height):
        """image u8 [3,S,S], depth and height f32 [1,S,S] -> the five outputs without their batch axis."""
        feed = {"image": image[None].astype(np.float32) / 255, "depth": depth[None], "height": height[None]}
        return {name: value[0] for name, value in self._run(feed).items()}

    def milliseconds(self, inputs, repeats=60):
        """Median of the processor time of one frame."""
        times = []
        for _ in range(repeats):
            start = time.process_time()
            self(**inputs)
            times.append(time.process_time() - start)
        return 1000 * float(np.median(times))
