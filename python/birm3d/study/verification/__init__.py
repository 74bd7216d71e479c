"""How accurate, how fast and how stable the program is: what work_precision() and stability() are made of."""
