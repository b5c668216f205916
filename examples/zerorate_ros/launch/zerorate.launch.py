"""ros2 launch zerorate_ros zerorate.launch.py odr_hz:=100.0 state:=/var/lib/imu.bin"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

DEFAULTS = {"odr_hz": "100.0", "full_scale_dps": "250.0", "state": "~/.ros/zerorate.bin"}


def generate_launch_description():
    arguments = [DeclareLaunchArgument(name, default_value=of) for name, of in DEFAULTS.items()]
    given = {name: LaunchConfiguration(name) for name in DEFAULTS}
    return LaunchDescription(
        [*arguments, Node(package="zerorate_ros", executable="node", parameters=[given])]
    )
