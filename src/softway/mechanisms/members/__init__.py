"""What a mechanism consists of: rigid bodies, joints, stops, springs and torques."""
