"""What the example in examples/ros2 is tested with: a simulated robot, and headers that stand for those of ROS."""
