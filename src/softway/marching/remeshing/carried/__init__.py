"""What passes from meshes to those that replace them: motion, memory, contact, heat, damage of ties."""
