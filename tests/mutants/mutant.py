"""What a table of mutants has per row."""
import dataclasses


@dataclasses.dataclass(frozen=True)
class Mutant:
    name: str
    file: str  # what is mutated
    old: str  # what is there, once
    new: str  # what replaces it
    program: str  # the test program that must fail
    path: str = ''  # the path it is compiled for, if another one would not notice
    source: str = ''  # the .cpp that is compiled, if the file is a header of no unit of kernels/
