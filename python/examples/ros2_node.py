#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A ROS 2 node that walks a robot to a goal with `crossnav serve` (docs/live.md). An example.

    ros2_node.py --ros-args -p goal:=chair -p camera_height_m:=0.6 -r image:=/camera/color/image_rect

Topics: image, depth (registered to it), camera_info, odom; out: cmd_vel. An action is a Twist for
`period_s`, then a zero Twist; only then the next pictures are looked at.
"""

import rclpy
from geometry_msgs.msg import Twist
from message_filters import ApproximateTimeSynchronizer, Subscriber
from nav_msgs.msg import Odometry
from rclpy.duration import Duration
from rclpy.node import Node
from sensor_msgs.msg import CameraInfo, Image

from crossnav import Error, live, ros


class CrossnavNode(Node):
    def __init__(self) -> None:
        super().__init__("crossnav")
        self.goal = self.declare_parameter("goal", "chair").value
        self.height_m = self.declare_parameter("camera_height_m", 0.88).value
        self.T_base_camera = ros.mounting(
            self.height_m, self.declare_parameter("camera_forward_m", 0.0).value)
        self.address = self.declare_parameter("socket", live.default_socket()).value
        self.client: live.Client | None = None
        self.acts_until = self.get_clock().now()
        self.is_moving = False
        self.twists = self.create_publisher(Twist, "cmd_vel", 1)
        topics = [Subscriber(self, Image, "image"), Subscriber(self, Image, "depth"),
                  Subscriber(self, CameraInfo, "camera_info"), Subscriber(self, Odometry, "odom")]
        self.frames = ApproximateTimeSynchronizer(topics, queue_size=10, slop=0.05)
        self.frames.registerCallback(self.look)
        self.create_timer(0.02, self.watch)

    def look(self, colour: Image, depth: Image, info: CameraInfo, odom: Odometry) -> None:
        # Pictures of a robot that still moves are of no use.
        if self.is_moving or ros.time_ns_of(depth.header) < self.acts_until.nanoseconds:
            return
        try:
            camera = ros.camera_of(info)
            if self.client is None:
                self.client = live.Client(camera, self.height_m, self.address,
                                          on_stop=lambda _: self.stand())
                if self.client.welcome.state.goal != self.goal:
                    self.client.set_goal(self.goal)
            answer = self.client.step(ros.observation_of(
                colour, depth, camera, ros.pose_of(odom), self.T_base_camera))
        except live.Refused as error:
            self.get_logger().warning(str(error))
        except Error as error:  # the next pictures connect again
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
