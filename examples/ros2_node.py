"""ROS 2: /imu/data_raw in, /imu/data out, its rates without their bias. The core needs no ROS."""

from zerorate_tools.host import FloatCorrector

KNOWN_RAD_S = 0.0005  # one sigma of the bias, for the covariance: 30 mdps


class ImuCore:
    """Corrects messages with the fields of sensor_msgs/Imu in place."""

    def __init__(self, odr_hz=100.0, full_scale_dps=250.0):
        self.corrector = FloatCorrector(odr_hz, full_scale_dps, rate="rad/s", accel="m/s2")
        self.before_ns = None

    def correct(self, message, temp_degc=25.0):
        """The same message, its angular velocity without bias."""
        stamp = message.header.stamp
        now_ns = stamp.sec * 1_000_000_000 + stamp.nanosec
        passed_s = (now_ns - self.before_ns) / 1e9 if self.before_ns is not None else None
        self.before_ns = now_ns
        if passed_s is not None and passed_s <= 0:
            passed_s = None  # the clock was set back: the sensor's own pace holds
        rate, accel = message.angular_velocity, message.linear_acceleration
        rates = (rate.x, rate.y, rate.z)
        rate.x, rate.y, rate.z = self.corrector.update(
            rates, (accel.x, accel.y, accel.z), temp_degc, passed_s
        )
        for place in (0, 4, 8):
            message.angular_velocity_covariance[place] += KNOWN_RAD_S**2
        return message


def main():
    """The node: parameters odr_hz and full_scale_dps; /imu/temperature where there is one."""
    import rclpy
    from rclpy.qos import qos_profile_sensor_data
    from sensor_msgs.msg import Imu, Temperature

    rclpy.init()
    node = rclpy.create_node("zerorate")
    odr_hz = node.declare_parameter("odr_hz", 100.0).value
    full_scale_dps = node.declare_parameter("full_scale_dps", 250.0).value
    core, temp_degc = ImuCore(odr_hz, full_scale_dps), [25.0]
    out = node.create_publisher(Imu, "/imu/data", qos_profile_sensor_data)

    def warmer(message):
        temp_degc[0] = message.temperature

    def correct(message):
        out.publish(core.correct(message, temp_degc[0]))

    node.create_subscription(Temperature, "/imu/temperature", warmer, qos_profile_sensor_data)
    node.create_subscription(Imu, "/imu/data_raw", correct, qos_profile_sensor_data)
    rclpy.spin(node)


if __name__ == "__main__":
    main()
