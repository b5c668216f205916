from setuptools import setup

NAME = "zerorate_ros"
setup(
    name=NAME,
    version="0.1.0",
    description="imu/data_raw in, imu/data out: its rates without the gyroscope's bias.",
    license="MIT",
    packages=[NAME],
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        (f"share/{NAME}/launch", ["launch/zerorate.launch.py"]),
    ],
    entry_points={"console_scripts": [f"node = {NAME}.node:main"]},
)
