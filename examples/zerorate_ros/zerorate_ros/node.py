"""ROS 2: imu/data_raw in, imu/data out, its rates without their bias. The core needs no ROS."""

from array import array
from math import radians
from pathlib import Path

from zerorate.storage.learned_store import LearnedStore
from zerorate.storage.save_schedule import SaveSchedule
from zerorate_tools.host import FloatCorrector, store_file

TOLERANCE_DPS = 0.01  # a bias that moved by less need not be written


class ImuCore:
    """Corrects messages with the fields of sensor_msgs/Imu in place, and keeps what it learned.

    tell: called with a line where what was learned cannot be written.
    """

    def __init__(self, odr_hz=100.0, full_scale_dps=250.0, state="~/.ros/zerorate.bin", tell=print):
        path = Path(state).expanduser()
        path.parent.mkdir(parents=True, exist_ok=True)
        self.corrector = FloatCorrector(odr_hz, full_scale_dps, rate="rad/s", accel="m/s2")
        self.learner = self.corrector.corrector
        self.lsb_per_dps = self.learner.sensor.gyro_lsb_per_dps
        self.store = LearnedStore(store_file(path), b"ros2", self.learner)
        self.path, self.tell = path, tell
        self.said = f"{path}: {self.store.in_words(self.store.load())}"
        tolerance = max(1, round(TOLERANCE_DPS * self.lsb_per_dps * 256))
        self.schedule = SaveSchedule(self.store, 3, tolerance, corrector=self.learner)
        self.bias_q8 = array("i", [0] * 3)
        self.before_ns, self.passed_s, self.messages = None, 0.0, 0

    def correct(self, message, temp_degc=25.0):
        """The same message, its angular velocity without bias."""
        stamp = message.header.stamp
        now_ns = stamp.sec * 1_000_000_000 + stamp.nanosec
        step_s = (now_ns - self.before_ns) / 1e9 if self.before_ns is not None else None
        self.before_ns = now_ns
        if step_s is not None and step_s <= 0:
            step_s = None  # the clock was set back: the sensor's own pace holds
        rate, accel = message.angular_velocity, message.linear_acceleration
        rates = (rate.x, rate.y, rate.z)
        rate.x, rate.y, rate.z = self.corrector.update(
            rates, (accel.x, accel.y, accel.z), temp_degc, step_s
        )
        if message.angular_velocity_covariance[0] >= 0:  # -1: there are no rates
            for axis in range(3):
                message.angular_velocity_covariance[4 * axis] += self.sigma_rad_s(axis) ** 2
        self.messages += 1
        self.passed_s += step_s or 1 / self.learner.sensor.odr_hz
        self.keep()
        return message

    def sigma_rad_s(self, axis):
        """One sigma of the bias that is subtracted."""
        return radians(self.learner.quality_lsb(axis) / self.lsb_per_dps)

    def keep(self, at_the_end=False):
        """Write what was learned, when the schedule says so."""
        for axis in range(3):
            self.bias_q8[axis] = round(self.learner.bias_lsb(axis) * 256)
        if not self.learner.learned:  # what is known of this rest alone is not kept
            return
        tried = self.schedule.saves
        if at_the_end and self.schedule.is_significant(self.bias_q8):
            written = self.store.save()
        elif self.schedule.offer(self.learner.state, self.bias_q8, int(self.passed_s)):
            written = True
        elif self.schedule.saves > tried:
            written = False
        else:
            return
        self.said = f"{self.path}: {'written' if written else 'cannot be written; is there room?'}"
        if not written:
            self.tell(self.said)

    def values(self):
        """What /diagnostics says, as texts by name."""
        found = {"messages": self.messages, "refused": self.corrector.refused, "store": self.said}
        for axis, bias in enumerate(self.corrector.bias()):
            found[f"bias {'xyz'[axis]} [rad/s]"] = f"{bias:.6f} +- {self.sigma_rad_s(axis):.6f}"
        return {name: str(value) for name, value in found.items()}


def main():
    """The node. Parameters: those of ImuCore; imu/temperature is taken where there is one."""
    import rclpy
    from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
    from rclpy.executors import ExternalShutdownException
    from rclpy.qos import qos_profile_sensor_data as qos
    from sensor_msgs.msg import Imu, Temperature

    rclpy.init()
    node = rclpy.create_node("zerorate")
    parameters = {"odr_hz": 100.0, "full_scale_dps": 250.0, "state": "~/.ros/zerorate.bin"}
    for name, default in parameters.items():
        parameters[name] = node.declare_parameter(name, default).value
    core = ImuCore(**parameters, tell=node.get_logger().warning)
    node.get_logger().info(core.said)
    newest = {"degc": 25.0, "messages": 0}
    out = node.create_publisher(Imu, "imu/data", qos)
    state = node.create_publisher(DiagnosticArray, "/diagnostics", 10)

    def diagnose():
        if core.messages == newest["messages"]:
            level, text = DiagnosticStatus.STALE, "nothing comes on imu/data_raw"
        elif core.learner.learned:
            level, text = DiagnosticStatus.OK, "the bias is known"
        else:
            level, text = DiagnosticStatus.WARN, "the bias is not known yet: let it rest"
        newest["messages"] = core.messages
        status = DiagnosticStatus(name="zerorate", level=level, message=text)
        status.values = [KeyValue(key=key, value=value) for key, value in core.values().items()]
        message = DiagnosticArray(status=[status])
        message.header.stamp = node.get_clock().now().to_msg()
        state.publish(message)

    def warmer(message):
        newest["degc"] = message.temperature

    def correct(message):
        out.publish(core.correct(message, newest["degc"]))

    node.create_subscription(Temperature, "imu/temperature", warmer, qos)
    node.create_subscription(Imu, "imu/data_raw", correct, qos)
    node.create_timer(1.0, diagnose)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        core.keep(at_the_end=True)
