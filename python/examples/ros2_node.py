#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A ROS 2 node that walks a robot to a goal with `crossnav serve` (docs/live.md). An example.

    ros2_node.py --ros-args -p goal:=chair -r image:=/camera/color/image_rect

Topics: image, camera_info (of colour), depth, depth_info, odom; out: cmd_vel. TF says how the depth
camera is mounted on `base_frame`, and where the colour camera sits beside it. An action is a Twist
for `period_s`, then a zero Twist; only then the next pictures are looked at.
"""

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from message_filters import ApproximateTimeSynchronizer, Subscriber
from nav_msgs.msg import Odometry
from numpy.typing import NDArray
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import CameraInfo, Image
from tf2_ros import Buffer, TransformException, TransformListener

from crossnav import Error, Observation, live, ros


class CrossnavNode(Node):
    def __init__(self) -> None:
        super().__init__("crossnav")
        self.goal = self.declare_parameter("goal", "chair").value
        # Below the robot on the ground, x ahead, z up.
        self.base_frame = self.declare_parameter("base_frame", "base_footprint").value
        self.address = self.declare_parameter("socket", live.default_socket()).value
        self.client: live.Client | None = None
        self.acts_until = self.get_clock().now()
        self.is_moving = False
        self.twists = self.create_publisher(Twist, "cmd_vel", 1)
        self.transforms = Buffer()
        self.listener = TransformListener(self.transforms, self)
        topics = [Subscriber(self, Image, "image"), Subscriber(self, CameraInfo, "camera_info"),
                  Subscriber(self, Image, "depth"), Subscriber(self, CameraInfo, "depth_info"),
                  Subscriber(self, Odometry, "odom")]
        self.frames = ApproximateTimeSynchronizer(topics, queue_size=10, slop=0.05)
        self.frames.registerCallback(self.look)
        self.create_timer(0.02, self.watch)

    def transform(self, to: str, frame: str) -> NDArray[np.float64]:
        """4 x 4, of points in `frame` to `to`: the newest that is known, as heads are still here."""
        return ros.pose_of(self.transforms.lookup_transform(to, frame, Time()))

    def observation_of(self, colour: Image, info: CameraInfo, depth: Image,
                       depth_info: CameraInfo, odom: Odometry) -> Observation:
        camera, frame = ros.camera_of(depth_info), depth.header.frame_id
        T_world_base = ros.pose_of(odom)
        if odom.child_frame_id != self.base_frame:  # odometry of a frame above the ground
            T_world_base = T_world_base @ self.transform(odom.child_frame_id, self.base_frame)
        T_base_camera = self.transform(self.base_frame, frame)
        if colour.header.frame_id == frame:  # the driver has registered depth to colour
            return ros.observation_of(colour, depth, camera, T_world_base, T_base_camera)
        return ros.observation_of(colour, depth, camera, T_world_base, T_base_camera,
                                  ros.camera_of(info),
                                  self.transform(frame, colour.header.frame_id))

    def look(self, colour: Image, info: CameraInfo, depth: Image, depth_info: CameraInfo,
             odom: Odometry) -> None:
        # Skips pictures of a moving robot.
        if self.is_moving or ros.time_ns_of(depth.header) < self.acts_until.nanoseconds:
            return
        try:
            observation = self.observation_of(colour, info, depth, depth_info, odom)
            if self.client is None:
                self.client = live.Client(observation.camera, address=self.address,
                                          on_stop=lambda _: self.stand())
                if self.client.welcome.state.goal != self.goal:
                    self.client.set_goal(self.goal)
            answer = self.client.step(observation)
        except (live.Refused, TransformException) as error:  # TF may arrive after the pictures
            self.get_logger().warning(str(error))
        except Error as error:  # the next pictures reconnect
            self.get_logger().error(str(error))
            self.client = None
            self.stand()
        else:
            self.act(answer)

    def act(self, answer: live.Answer) -> None:
        if answer.state.phase != live.Phase.SEARCHING:
            self.get_logger().info(f"{self.goal}: {answer.state.phase.name.lower()}",
                                   throttle_duration_sec=5.0)
        self.twists.publish(ros.fill_twist(answer.command, Twist()))
        self.is_moving = answer.command.duration_s > 0
        self.acts_until = self.get_clock().now() + Duration(seconds=answer.command.duration_s)

    def watch(self) -> None:
        """Ends actions in time, and hears the server's watchdog."""
        if self.is_moving and self.get_clock().now() >= self.acts_until:
            self.stand()
        try:
            if self.client is not None:
                self.client.poll()
        except Error as error:
            self.get_logger().error(str(error))
            self.client = None
            self.stand()

    def stand(self) -> None:
        self.is_moving = False
        self.twists.publish(Twist())


def main() -> None:
    rclpy.init()
    node = CrossnavNode()
    try:
        rclpy.spin(node)
    finally:
        node.stand()
        node.destroy_node()
        rclpy.shutdown()


if __name__ == "__main__":
    main()
