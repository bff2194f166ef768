"""Export of the motion of rigid bodies to files of other programs."""
