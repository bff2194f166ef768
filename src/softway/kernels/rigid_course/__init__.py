"""States of rigid mechanisms after every few slabs (time steps), in compiled loops."""
