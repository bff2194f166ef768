"""Copies of tables; assignments of whole arrays would count references, as no kernel of the slabs does."""

from softway.kernels.jit.compilation import uncounted


@uncounted
def copy_numbers(source, target):
    """Copy numbers (n,)."""
    for i in range(len(source)):
        target[i] = source[i]


@uncounted
def copy_rows(source, target):
    """Copy rows (n, m)."""
    for i in range(source.shape[0]):
        for j in range(source.shape[1]):
            target[i, j] = source[i, j]


@uncounted
def copy_tensors(source, target):
    """Copy tensors (n, m, k)."""
    for i in range(source.shape[0]):
        for j in range(source.shape[1]):
            for k in range(source.shape[2]):
                target[i, j, k] = source[i, j, k]
