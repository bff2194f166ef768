"""Gate for run folders that somebody sent: what is read is data, of the size that it announces."""
