# SPDX-License-Identifier: MIT
"""Sequential object-goal navigation across floors: crossnav's C++ library in Python.

World frame: right-handed, z up, metres; x is forward at yaw 0. Depth is planar, metres, 0 invalid.
See docs/python.md of the repository.
"""

from crossnav._config import Settings
from crossnav._core import (
    CATEGORIES,
    VERSION,
    Action,
    Agent,
    AgentPose,
    CameraIntrinsics,
    Claim,
    ClaimVerdict,
    Config,
    DenseEncoder,
    Detection,
    Detector,
    Episode,
    ExplorationOption,
    Hooks,
    MemoryCluster,
    Observation,
    Perception,
    Scene,
    Segmenter,
    SemanticMemory,
    Simulator,
    StairSegmenter,
    StepResult,
    VoxelMap,
    VoxelState,
    ask,
    category_of,
    generate_house,
    list_scenes,
    load_map,
    make_episode,
    map_header,
    read_episodes,
    read_recording,
    run_episode,
    save_map,
    write_embedded_house,
)
from crossnav._errors import Error
from crossnav._records import Record, metrics, play

__version__: str = VERSION

__all__ = [
    "CATEGORIES", "Action", "Agent", "AgentPose", "CameraIntrinsics", "Claim", "ClaimVerdict",
    "Config", "DenseEncoder", "Detection", "Detector", "Episode", "Error", "ExplorationOption",
    "Hooks", "MemoryCluster", "Observation", "Perception", "Record", "Scene", "Segmenter",
    "SemanticMemory", "Settings", "Simulator", "StairSegmenter", "StepResult", "VoxelMap",
    "VoxelState", "__version__", "ask", "category_of", "generate_house", "list_scenes", "load_map",
    "make_episode", "map_header", "metrics", "play", "read_episodes", "read_recording",
    "run_episode", "save_map", "write_embedded_house",
]
