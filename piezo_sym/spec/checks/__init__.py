"""What must hold between the tables of a spec: names, references, laws, lanes, values."""
